#include "models/base/document_tree.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>

#include "models/base/error.hpp"

namespace kerf {
namespace {

constexpr int deepest_table = 16;  // far beyond any block path; keeps the recursion bounded

[[noreturn]] void refuse(const std::string& name, const toml::source_position& place, std::string_view what) {
  throw InputError(fmt::format("{}:{}:{}: {}", name, place.line, place.column, what));
}

Node convert(const toml::node& source, const std::string& name, int depth) {
  const toml::source_position place = source.source().begin;
  if (depth > deepest_table) refuse(name, place, fmt::format("tables are nested deeper than {}", deepest_table));
  Node node;
  node.line = std::max(1, static_cast<int>(place.line));
  node.column = std::max(1, static_cast<int>(place.column));
  if (const auto* table = source.as_table()) {
    Node::Table entries;
    for (const auto& [key, value] : *table) {
      Node child = convert(value, name, depth + 1);
      child.key_line = static_cast<int>(key.source().begin.line);
      child.key_column = static_cast<int>(key.source().begin.column);
      entries.emplace(std::string(key.str()), std::move(child));
    }
    node.value = std::move(entries);
  } else if (const auto* array = source.as_array()) {
    Node::Array elements;
    for (const toml::node& element : *array) elements.push_back(convert(element, name, depth + 1));
    node.value = std::move(elements);
  } else if (const auto* string = source.as_string()) {
    node.value = string->get();
  } else if (const auto* real = source.as_floating_point()) {
    node.value = real->get();
  } else if (const auto* integer = source.as_integer()) {
    constexpr double largest_exact = 9007199254740992.0;  // 2^53
    const auto number = static_cast<double>(integer->get());
    if (std::abs(number) > largest_exact) refuse(name, place, fmt::format("{} is too large", integer->get()));
    node.value = number;
  } else if (const auto* boolean = source.as_boolean()) {
    node.value = boolean->get();
  } else {
    refuse(name, place, "a date or time has no meaning here");
  }
  return node;
}

std::string in_quotes(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      result += {'\\', c};
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      result += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
    else
      result += c;
  }
  return result + '"';
}

std::string key_text(std::string_view key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char c) {
    return (c < 0x80 && std::isalnum(c)) || c == '_' || c == '-';
  });
  return bare ? std::string(key) : in_quotes(key);
}

/// The parser descends one call per part of a dotted key, and a file of nothing but "a.a.a.a..." would exhaust the
/// stack.
void refuse_endless_keys(std::string_view toml, const std::string& name) {
  constexpr std::size_t longest_document = 1 << 20;
  constexpr int most_dots = 64;  // on one line; dots in a row are an ellipsis and no key
  if (toml.size() > longest_document)
    refuse(name, {1, 1}, fmt::format("{} bytes are too many for a scene", toml.size()));
  int dots = 0;
  toml::source_position place{1, 1};
  for (std::size_t i = 0; i < toml.size(); ++i, ++place.column) {
    if (toml[i] == '\n') {
      dots = 0;
      place = {place.line + 1, 0};
    } else if (toml[i] == '.' && (i + 1 == toml.size() || toml[i + 1] != '.') && ++dots > most_dots) {
      refuse(name, place, fmt::format("this line has more than {} dots; break it into several lines", most_dots));
    }
  }
}

}  // namespace

Node parse_toml(std::string_view toml, const std::string& name) {
  refuse_endless_keys(toml, name);
  try {
    return convert(toml::parse(toml), name, 0);
  } catch (const toml::parse_error& error) {
    refuse(name, error.source().begin, error.description());
  }
}

std::string toml_text(const Node& node) {
  struct Writer {
    std::string operator()(double number) const { return fmt::format("{:#}", number); }
    std::string operator()(bool flag) const { return flag ? "true" : "false"; }
    std::string operator()(const std::string& text) const { return in_quotes(text); }
    std::string operator()(const Node::Array& elements) const {
      std::string list;
      for (const Node& element : elements) list += (list.empty() ? "" : ", ") + toml_text(element);
      return "[" + list + "]";
    }
    std::string operator()(const Node::Table& entries) const {
      std::string list;
      for (const auto& [key, value] : entries)
        list += fmt::format("{}{} = {}", list.empty() ? "" : ", ", key_text(key), toml_text(value));
      return "{" + list + "}";
    }
  };
  return std::visit(Writer{}, node.value);
}

std::string shown(const Node& node) {
  if (const auto* number = std::get_if<double>(&node.value)) return fmt::format("{}", *number);
  constexpr std::size_t longest = 70;
  std::string text = toml_text(node);
  if (text.size() <= longest) return text;
  std::size_t end = longest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;  // never inside a UTF-8 character
  return text.substr(0, end) + "...";
}

}  // namespace kerf
