#include "models/base/parameter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace kerf {
namespace {

/// Asking for a key that the block never declared is a mistake in the program, not in the user's file.
template <class Map>
const typename Map::mapped_type& declared(const Map& map, std::string_view key, std::string_view place) {
  const auto entry = map.find(key);
  if (entry == map.end()) throw std::logic_error(fmt::format("{}: no value was read for key \"{}\"", place, key));
  return entry->second;
}

/// Edits (insert, delete, replace, swap of neighbours) that turn `a` into `b`; letter case does not count.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  const auto same = [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
  };
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same(a[i - 1], b[j - 1]) ? 0 : 1)});
      if (i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]))
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

}  // namespace

std::string allowed_range(const Parameter& parameter) {
  const std::string unit = parameter.unit == "1" ? "" : fmt::format(" {}", parameter.unit);
  const bool below = std::isfinite(parameter.lower), above = std::isfinite(parameter.upper);
  if (below && above) return fmt::format("{:g} to {:g}{}", parameter.lower, parameter.upper, unit);
  if (below) return fmt::format("at least {:g}{}", parameter.lower, unit);
  if (above) return fmt::format("at most {:g}{}", parameter.upper, unit);
  return unit.empty() ? "any number" : fmt::format("any number of{}", unit);
}

Parameter number(std::string key, std::string unit, double lower, double upper, std::string meaning) {
  Parameter parameter;
  parameter.key = std::move(key);
  parameter.unit = std::move(unit);
  parameter.lower = lower;
  parameter.upper = upper;
  parameter.meaning = std::move(meaning);
  return parameter;
}

Parameter text(std::string key, std::string meaning, std::vector<std::string> choices) {
  Parameter parameter;
  parameter.key = std::move(key);
  parameter.kind = Parameter::Kind::text;
  parameter.choices = std::move(choices);
  parameter.meaning = std::move(meaning);
  return parameter;
}

Parameter quantity(std::string key, std::string meaning) {
  Parameter parameter = text(std::move(key), std::move(meaning));
  parameter.kind = Parameter::Kind::quantity;
  return parameter;
}

Parameter flag(std::string key, std::string meaning) {
  Parameter parameter;
  parameter.key = std::move(key);
  parameter.kind = Parameter::Kind::flag;
  parameter.meaning = std::move(meaning);
  return parameter;
}

Parameter list(std::string key, std::string meaning, std::vector<std::string> choices) {
  Parameter parameter = text(std::move(key), std::move(meaning), std::move(choices));
  parameter.kind = Parameter::Kind::list;
  return parameter;
}

double Values::number(std::string_view key) const {
  return declared(numbers_, key, place_);
}
const std::string& Values::text(std::string_view key) const {
  return declared(texts_, key, place_);
}
bool Values::flag(std::string_view key) const {
  return declared(flags_, key, place_);
}
const std::vector<std::string>& Values::list(std::string_view key) const {
  return declared(lists_, key, place_);
}

bool Values::has(std::string_view key) const {
  return numbers_.contains(key) || texts_.contains(key) || flags_.contains(key) || lists_.contains(key);
}

std::string Values::where(std::string_view key) const {
  const auto place = places_.find(key);
  return place == places_.end() ? place_ : place->second;
}

std::optional<std::string> nearest(std::string_view word, std::span<const std::string> candidates) {
  constexpr std::size_t longest_word = 80;
  if (word.empty() || word.size() > longest_word) return std::nullopt;
  const std::string* best = nullptr;
  std::size_t fewest = 0;
  for (const std::string& candidate : candidates) {
    const std::size_t edits = edit_distance(word, candidate);
    // Two edits in five letters still read as a slip; more is another word.
    const bool near_enough = 5 * edits <= 2 * std::max(word.size(), candidate.size());
    if (near_enough && (!best || edits < fewest)) {
      best = &candidate;
      fewest = edits;
    }
  }
  return best ? std::optional(*best) : std::nullopt;
}

}  // namespace kerf
