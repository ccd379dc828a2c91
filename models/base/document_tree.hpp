#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "models/base/document.hpp"

namespace kerf {

/// A value of a TOML file with the place where it stands. Unlike the parser's own nodes it keeps that place when a
/// calibration copies and patches the document.
struct Node {
  using Array = std::vector<Node>;
  using Table = std::map<std::string, Node, std::less<>>;
  using Value = std::variant<double, bool, std::string, Array, Table>;

  int line = 1, column = 1;          ///< of the value; counted from 1
  int key_line = 1, key_column = 1;  ///< of the key in front of it
  Value value;

  const Table* table() const { return std::get_if<Table>(&value); }
  Table* table() { return std::get_if<Table>(&value); }
};

struct Document::Tree {
  Node root;
};

/// Parses TOML; throws InputError beginning with `name`:line:column.
Node parse_toml(std::string_view toml, const std::string& name);

/// The value at a dotted path of tables, or nullptr. `NodeType` is Node or const Node.
template <class NodeType>
NodeType* find_node(NodeType& root, std::string_view path) {
  NodeType* node = &root;
  while (!path.empty()) {
    const std::size_t dot = path.find('.');
    auto* table = node->table();
    if (!table) return nullptr;
    const auto child = table->find(path.substr(0, dot));
    if (child == table->end()) return nullptr;
    node = &child->second;
    path = dot == path.npos ? std::string_view() : path.substr(dot + 1);
  }
  return node;
}

/// The TOML spelling of a value on one line: `"40 GPa"`, `0.3`, `["F_c", "F_t"]`. Numbers read back bit for bit.
std::string toml_text(const Node& node);

/// The same for a message: numbers as people write them, long values cut short.
std::string shown(const Node& node);

/// "cohesive.mode_I" + "toughness"; the top of the file is "".
inline std::string join_path(std::string_view block, std::string_view key) {
  return block.empty() ? std::string(key) : std::string(block) + "." + std::string(key);
}

}  // namespace kerf
