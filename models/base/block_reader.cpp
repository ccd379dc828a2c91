#include "models/base/block_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "models/base/error.hpp"
#include "models/base/quantity.hpp"

namespace kerf {
namespace {

constexpr std::string_view law_key = "law";

std::string title(std::string_view path) {
  return path.empty() ? "" : fmt::format("[{}] ", path);
}

/// "; did you mean "strength"?" or, when nothing is near, the whole choice.
std::string suggestion(std::string_view word, const std::vector<std::string>& candidates) {
  if (const auto near = nearest(word, candidates)) return fmt::format("; did you mean \"{}\"?", *near);
  if (candidates.empty()) return "";
  return fmt::format("; known here: {}", fmt::join(candidates, ", "));
}

/// A fallback is declared as a file would hold it; text and quantities may leave out the quotes.
Node fallback_node(const Parameter& parameter) {
  const bool quotes_left_out =
      (parameter.kind == Parameter::Kind::text || parameter.unit != "1") && !parameter.fallback->starts_with('"');
  if (!quotes_left_out) return parse_toml("value = " + *parameter.fallback, "fallback").table()->at("value");
  Node node;
  node.value = *parameter.fallback;
  return node;
}

void check_choice(const std::string& word, const std::vector<std::string>& choices) {
  if (choices.empty() || std::find(choices.begin(), choices.end(), word) != choices.end()) return;
  const auto near = nearest(word, choices);
  throw std::invalid_argument(fmt::format("is not known{} (allowed: {})",
                                          near ? fmt::format("; did you mean \"{}\"?", *near) : std::string(),
                                          fmt::join(choices, ", ")));
}

std::string read_text(const Node& node, const Parameter& parameter) {
  const auto* word = std::get_if<std::string>(&node.value);
  if (!word) throw std::invalid_argument(fmt::format("is {}; a string belongs here", kind_of(node)));
  check_choice(*word, parameter.choices);
  return *word;
}

std::vector<std::string> read_list(const Node& node, const Parameter& parameter) {
  const auto* elements = std::get_if<Node::Array>(&node.value);
  if (!elements) throw std::invalid_argument(fmt::format("is {}; a list of strings belongs here", kind_of(node)));
  std::vector<std::string> words;
  for (const Node& element : *elements) {
    const auto* word = std::get_if<std::string>(&element.value);
    if (!word) throw std::invalid_argument(fmt::format("holds {}; only strings belong here", kind_of(element)));
    try {
      check_choice(*word, parameter.choices);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("holds \"{}\", which {}", *word, error.what()));
    }
    if (std::find(words.begin(), words.end(), *word) != words.end())
      throw std::invalid_argument(fmt::format("holds \"{}\" twice", *word));
    words.push_back(*word);
  }
  return words;
}

}  // namespace

std::string BlockReader::place(int line, int column) const {
  return fmt::format("{}:{}:{}", name_, line, column);
}

std::vector<const Block*> BlockReader::blocks_at(std::string_view path) const {
  std::vector<const Block*> blocks;
  for (const Block& block : known_)
    if (block.path == path) blocks.push_back(&block);
  return blocks;
}

std::vector<std::string> BlockReader::variants_at(std::string_view path) const {
  std::vector<std::string> variants;
  for (const Block* block : blocks_at(path))
    if (!block->variant.empty()) variants.push_back(block->variant);
  return variants;
}

bool BlockReader::is_branch(std::string_view path) const {
  return std::any_of(known_.begin(), known_.end(), [&](const Block& block) {
    return block.path.starts_with(path) && block.path.size() > path.size() &&
           (path.empty() || block.path[path.size()] == '.');
  });
}

/// Names of the tables that may stand directly in table `path`.
std::vector<std::string> BlockReader::children_of(std::string_view path) const {
  std::vector<std::string> children;
  for (const Block& block : known_) {
    const std::size_t start = path.empty() ? 0 : path.size() + 1;
    if (block.path.size() <= start || !block.path.starts_with(path) || (start > 0 && block.path[start - 1] != '.'))
      continue;
    const std::string child = block.path.substr(start, block.path.find('.', start) - start);
    if (std::find(children.begin(), children.end(), child) == children.end()) children.push_back(child);
  }
  return children;
}

std::string BlockReader::law_of(const Node& table, std::string_view path) const {
  const auto variants = variants_at(path);
  if (variants.empty()) return "";
  const auto entry = table.table()->find(law_key);
  if (entry == table.table()->end())
    throw InputError(fmt::format("{}: {}lacks the key \"law\" (allowed: {})", place(table.line, table.column),
                                 title(path), fmt::join(variants, ", ")));
  const Node& law = entry->second;
  try {
    return read_text(law, text(std::string(law_key), "", variants));
  } catch (const std::invalid_argument& error) {
    throw InputError(
        fmt::format("{}: {}law = {} {}", place(law.line, law.column), title(path), shown(law), error.what()));
  }
}

std::vector<const Parameter*> BlockReader::parameters_of(const Node& table, std::string_view path) const {
  const std::string law = law_of(table, path);
  std::vector<const Parameter*> parameters;
  for (const Block* block : blocks_at(path))
    if (block->variant.empty() || block->variant == law)
      for (const Parameter& parameter : block->parameters) parameters.push_back(&parameter);
  return parameters;
}

void BlockReader::refuse_name(const std::string& key, const Node& value, const std::string& path,
                              std::vector<std::string> keys) const {
  const std::string where = place(value.key_line, value.key_column);
  const auto tables = children_of(path);
  if (value.table()) {
    std::vector<std::string> paths;
    paths.reserve(tables.size());
    for (const std::string& child : tables) paths.push_back(join_path(path, child));
    throw InputError(fmt::format("{}: there is no table [{}]{}", where, join_path(path, key),
                                 suggestion(join_path(path, key), paths)));
  }
  for (const Block* block : blocks_at(path))
    for (const Parameter& parameter : block->parameters)
      if (parameter.key == key)
        throw InputError(fmt::format("{}: {}has no key \"{}\"; it belongs to law = \"{}\"", where, title(path), key,
                                     block->variant));
  keys.insert(keys.end(), tables.begin(), tables.end());
  if (!nearest(key, keys))
    for (const Block& block : known_)
      for (const Parameter& parameter : block.parameters)
        if (parameter.key == key && !block.path.empty())
          throw InputError(fmt::format("{}: {}has no key \"{}\"; it belongs in [{}]", where,
                                       path.empty() ? "the top of the file " : title(path), key, block.path));
  throw InputError(fmt::format("{}: {}has no key \"{}\"{}", where, path.empty() ? "the top of the file " : title(path),
                               key, suggestion(key, keys)));
}

void BlockReader::check_child(const Node& child, const std::string& path) const {
  const auto blocks = blocks_at(path);
  const bool repeated = std::any_of(blocks.begin(), blocks.end(), [](const Block* block) { return block->repeated; });
  const std::string where = place(child.line, child.column);
  if (!repeated) {
    if (!child.table())
      throw InputError(fmt::format("{}: {} is {}; a table [{}] belongs here", where, path, kind_of(child), path));
    return check_names(child, path);
  }
  const auto* elements = std::get_if<Node::Array>(&child.value);
  if (!elements)
    throw InputError(fmt::format("{}: {} is {}; tables [[{}]] belong here", where, path, kind_of(child), path));
  for (const Node& element : *elements) {
    if (!element.table())
      throw InputError(fmt::format("{}: {} holds {}; only tables [[{}]] belong here",
                                   place(element.line, element.column), path, kind_of(element), path));
    check_names(element, path);
  }
}

void BlockReader::check_names(const Node& table, const std::string& path) const {
  std::vector<std::string> keys;
  for (const Parameter* parameter : parameters_of(table, path)) keys.push_back(parameter->key);
  if (!variants_at(path).empty()) keys.emplace_back(law_key);
  for (const auto& [key, value] : *table.table()) {
    const std::string child = join_path(path, key);
    if (!blocks_at(child).empty() || is_branch(child))
      check_child(value, child);
    else if (std::find(keys.begin(), keys.end(), key) == keys.end())
      refuse_name(key, value, path, keys);
  }
}

void BlockReader::store(const Parameter& parameter, const Node& node, Values& values) const {
  switch (parameter.kind) {
    case Parameter::Kind::number:
      values.numbers_[parameter.key] = read_number(node, parameter);
      break;
    case Parameter::Kind::quantity:
      values.texts_[parameter.key] =
          std::holds_alternative<double>(node.value) ? toml_text(node) : read_text(node, parameter);
      break;
    case Parameter::Kind::text:
      values.texts_[parameter.key] = read_text(node, parameter);
      break;
    case Parameter::Kind::flag:
      if (const auto* flag = std::get_if<bool>(&node.value))
        values.flags_[parameter.key] = *flag;
      else
        throw std::invalid_argument(fmt::format("is {}; true or false belongs here", kind_of(node)));
      break;
    case Parameter::Kind::list:
      values.lists_[parameter.key] = read_list(node, parameter);
      break;
  }
}

void BlockReader::read_parameter(const Parameter& parameter, const Node& table, std::string_view path,
                                 Values& values) const {
  const auto entry = table.table()->find(parameter.key);
  if (entry == table.table()->end()) {
    if (parameter.fallback)
      store(parameter, fallback_node(parameter), values);
    else if (!parameter.optional)
      throw InputError(fmt::format(
          "{}: {}lacks the key \"{}\"{}: {}", place(table.line, table.column),
          path.empty() ? "the top of the file " : title(path), parameter.key,
          parameter.kind == Parameter::Kind::number ? fmt::format(" (allowed: {})", allowed_range(parameter)) : "",
          parameter.meaning));
    return;
  }
  const Node& node = entry->second;
  const std::string where = place(node.line, node.column);
  try {
    store(parameter, node, values);
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: {}{} = {} {}", where, title(path), parameter.key, shown(node), error.what()));
  }
  values.places_[parameter.key] = where;
}

Values BlockReader::read_table(const Node& table, std::string_view path) const {
  Values values;
  values.place_ = place(table.line, table.column);
  values.variant_ = law_of(table, path);
  for (const Parameter* parameter : parameters_of(table, path)) read_parameter(*parameter, table, path, values);
  return values;
}

void BlockReader::read_block(const Block& block, Contents& contents) const {
  const Node* node = find_node(root_, block.path);
  if (node) {
    auto& repeats = contents.blocks_[block.path];
    if (const auto* elements = std::get_if<Node::Array>(&node->value))
      for (const Node& element : *elements) repeats.push_back(read_table(element, block.path));
    else
      repeats.push_back(read_table(*node, block.path));
    return;
  }
  if (!block.required) return;
  // A table inside an optional table is needed only with it.
  for (const Block& other : known_)
    if (!other.required && !other.path.empty() && block.path.starts_with(other.path + ".") &&
        !find_node(root_, other.path))
      return;
  const bool has_fallbacks =
      !block.repeated && variants_at(block.path).empty() &&
      std::all_of(block.parameters.begin(), block.parameters.end(),
                  [](const Parameter& parameter) { return parameter.fallback || parameter.optional; });
  if (!has_fallbacks)
    throw InputError(fmt::format("{}: the table {} is missing: {}", place(1, 1),
                                 fmt::format(fmt::runtime(block.repeated ? "[[{}]]" : "[{}]"), block.path),
                                 block.meaning));
  Node empty;
  empty.value = Node::Table();
  contents.blocks_[block.path].push_back(read_table(empty, block.path));
}

Contents BlockReader::read() const {
  check_names(root_, "");
  Contents contents;
  for (const Block& block : known_)
    if (!contents.has(block.path)) read_block(block, contents);
  return contents;
}

}  // namespace kerf
