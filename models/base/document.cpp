#include "models/base/document.hpp"

#include <fmt/format.h>

#include <algorithm>
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

constexpr std::string_view law_key = "law";

std::vector<std::string> variants_of(std::string_view path, const std::vector<Block>& known) {
  std::vector<std::string> variants;
  for (const Block& block : known)
    if (block.path == path && !block.variant.empty()) variants.push_back(block.variant);
  return variants;
}

/// The first declaration of `path` that is `wanted`; what is looked for is called `what` in the message.
template <class Wanted>
const Parameter& find_declared(std::string_view path, const std::vector<Block>& known, std::string_view where,
                               std::string_view what, Wanted wanted) {
  const auto [block_path, key] = split_path(path);
  std::vector<std::string> paths;
  for (const Block& block : known) {
    if (block.repeated) continue;
    for (const Parameter& parameter : block.parameters) {
      if (!wanted(parameter)) continue;
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
  throw InputError(fmt::format("{}: there is no {} \"{}\"{}", where, what, path, hint));
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

std::optional<std::string> Document::text_at(std::string_view path) const {
  const Node* node = find_node(tree_->root, path);
  const auto* words = node ? std::get_if<std::string>(&node->value) : nullptr;
  return words ? std::optional(*words) : std::nullopt;
}

const Parameter& Document::find_number(std::string_view path, const std::vector<Block>& known, std::string_view where) {
  const auto is_number = [](const Parameter& parameter) { return parameter.kind == Parameter::Kind::number; };
  return find_declared(path, known, where, "numeric parameter", is_number);
}

Parameter Document::find_parameter(std::string_view path, const std::vector<Block>& known, std::string_view where) {
  const auto [block_path, key] = split_path(path);
  if (key == law_key)
    if (const std::vector<std::string> laws = variants_of(block_path, known); !laws.empty())
      return text(std::string(law_key), "the law of this block", laws);
  const auto is_word = [](const Parameter& parameter) { return parameter.kind != Parameter::Kind::list; };
  return find_declared(path, known, where, "parameter", is_word);
}

/// `value_for` makes the value from the declaration that holds for the law this document has.
template <class Value>
void Document::set(std::string_view path, Value value_for, const std::vector<Block>& known) {
  const auto [block_path, key] = split_path(path);
  const std::string name(key);
  Tree patched = *tree_;
  Node* block = find_node(patched.root, block_path);
  if (!block || !block->table())
    throw InputError(fmt::format("{}: \"{}\" cannot be set: there is no table [{}]", name_, path, block_path));
  const auto write = [&](Node::Value value) {
    Node unwritten;  // a key that only had its fallback gets the place of its table
    unwritten.line = unwritten.key_line = block->line;
    unwritten.column = unwritten.key_column = block->column;
    block->table()->try_emplace(name, unwritten).first->second.value = std::move(value);
    tree_ = std::make_shared<const Tree>(std::move(patched));
  };
  if (key == law_key && !variants_of(block_path, known).empty()) return write(value_for(text(name, "")));
  for (const Parameter* parameter : BlockReader(patched.root, name_, known).parameters_of(*block, block_path))
    if (parameter->key == key) return write(value_for(*parameter));
  throw InputError(fmt::format("{}:{}:{}: [{}] with this law has no key \"{}\"", name_, block->line, block->column,
                               block_path, key));
}

void Document::set_number(std::string_view path, double value, const std::vector<Block>& known) {
  find_number(path, known, name_);
  set(
      path, [&](const Parameter& parameter) { return write_number(value, parameter); }, known);
}

void Document::set_text(std::string_view path, const std::string& text, const std::vector<Block>& known) {
  find_parameter(path, known, name_);
  const auto value_for = [&](const Parameter& parameter) -> Node::Value {
    if (parameter.kind != Parameter::Kind::flag) return text;
    if (text == "true" || text == "false") return text == "true";
    throw InputError(fmt::format("{}: \"{}\" cannot be \"{}\"; it is true or false", name_, path, text));
  };
  set(path, value_for, known);
}

void Document::add_table(std::string_view path, const std::vector<Block>& known) {
  const bool declared = std::any_of(known.begin(), known.end(),
                                    [&](const Block& block) { return block.path == path && !block.repeated; });
  if (!declared) throw std::logic_error(fmt::format("no block [{}] is declared", path));
  Tree patched = *tree_;
  Node* node = &patched.root;
  for (std::string_view rest = path; !rest.empty();) {
    const std::size_t dot = rest.find('.');
    Node empty;
    empty.value = Node::Table();
    node = &node->table()->try_emplace(std::string(rest.substr(0, dot)), empty).first->second;
    if (!node->table()) return;  // something else stands there: the reader will say so, with its place
    rest = dot == rest.npos ? std::string_view() : rest.substr(dot + 1);
  }
  tree_ = std::make_shared<const Tree>(std::move(patched));
}

void Document::remove(std::string_view path) {
  const auto [block_path, key] = split_path(path);
  Tree patched = *tree_;
  Node* block = find_node(patched.root, block_path);
  if (!block || !block->table()) return;
  if (const auto entry = block->table()->find(key); entry != block->table()->end()) block->table()->erase(entry);
  tree_ = std::make_shared<const Tree>(std::move(patched));
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
