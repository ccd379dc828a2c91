#include "models/base/document.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "models/base/atomic_file.hpp"
#include "models/base/block_reader.hpp"
#include "models/base/document_tree.hpp"
#include "models/base/error.hpp"
#include "models/base/quantity.hpp"

namespace kerf {
namespace {

struct Split {
  std::string_view block, key;
};

Split split_path(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  return dot == path.npos ? Split{"", path} : Split{path.substr(0, dot), path.substr(dot + 1)};
}

}  // namespace

bool Contents::has(std::string_view path) const {
  const auto block = blocks_.find(path);
  return block != blocks_.end() && !block->second.empty();
}

const Values& Contents::at(std::string_view path) const {
  if (!has(path)) throw std::logic_error(fmt::format("the block [{}] was not read", path));
  return blocks_.find(path)->second.front();
}

const std::vector<Values>& Contents::all(std::string_view path) const {
  static const std::vector<Values> none;
  const auto block = blocks_.find(path);
  return block == blocks_.end() ? none : block->second;
}

Document Document::load(const std::filesystem::path& file) {
  return parse(read_file(file), file.string());
}

Document Document::parse(std::string_view toml, std::string name) {
  Document document;
  document.tree_ = std::make_shared<const Tree>(Tree{parse_toml(toml, name)});
  document.name_ = std::move(name);
  return document;
}

Contents Document::read(const std::vector<Block>& known) const {
  return BlockReader(tree_->root, name_, known).read();
}

bool Document::has(std::string_view path) const {
  return find_node(tree_->root, path) != nullptr;
}

const Parameter& Document::find_number(std::string_view path, const std::vector<Block>& known, std::string_view where) {
  const auto [block_path, key] = split_path(path);
  std::vector<std::string> paths;
  for (const Block& block : known) {
    if (block.repeated) continue;
    for (const Parameter& parameter : block.parameters) {
      if (parameter.kind != Parameter::Kind::number) continue;
      if (block.path == block_path && parameter.key == key) return parameter;
      paths.push_back(join_path(block.path, parameter.key));
    }
  }
  const auto near = nearest(path, paths);
  std::vector<std::string> same_key;
  for (const std::string& candidate : paths)
    if (split_path(candidate).key == key) same_key.push_back(candidate);
  const std::string hint = near               ? fmt::format("; did you mean \"{}\"?", *near)
                           : same_key.empty() ? "; `kerf list` prints the parameters"
                                              : fmt::format("; did you mean \"{}\"?", same_key.front());
  throw InputError(fmt::format("{}: there is no numeric parameter \"{}\"{}", where, path, hint));
}

void Document::set_number(std::string_view path, double value, const std::vector<Block>& known) {
  find_number(path, known, name_);
  const auto [block_path, key] = split_path(path);
  Tree patched = *tree_;
  Node* block = find_node(patched.root, block_path);
  if (!block || !block->table())
    throw InputError(fmt::format("{}: \"{}\" cannot be set: there is no table [{}]", name_, path, block_path));
  for (const Parameter* parameter : BlockReader(patched.root, name_, known).parameters_of(*block, block_path)) {
    if (parameter->key != key) continue;
    Node unwritten;  // a key that only had its fallback gets the place of its table
    unwritten.line = unwritten.key_line = block->line;
    unwritten.column = unwritten.key_column = block->column;
    block->table()->try_emplace(std::string(key), unwritten).first->second.value = write_number(value, *parameter);
    tree_ = std::make_shared<const Tree>(std::move(patched));
    return;
  }
  throw InputError(fmt::format("{}:{}:{}: [{}] with this law has no key \"{}\"", name_, block->line, block->column,
                               block_path, key));
}

std::string Document::canonical() const {
  std::string text;
  for (const auto& [key, value] : *tree_->root.table()) {
    Node line;
    line.value = Node::Table{{key, value}};
    const std::string inline_table = toml_text(line);
    text += inline_table.substr(1, inline_table.size() - 2) + "\n";
  }
  return text;
}

}  // namespace kerf
