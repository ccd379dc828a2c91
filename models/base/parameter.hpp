#pragma once

#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kerf {

/// One key that an input file may hold. Declared once, beside the equations that use it; the reader, its errors,
/// `kerf list`, calibration bounds and the family tests all read this declaration.
struct Parameter {
  enum class Kind { number, quantity, text, flag, list };

  std::string key;
  Kind kind = Kind::number;
  std::string unit = "1";  ///< numbers: unit of the bounds and of messages; "1" marks a pure number
  double lower = -std::numeric_limits<double>::infinity();  ///< closed range, in `unit`
  double upper = std::numeric_limits<double>::infinity();
  std::vector<std::string> choices;     ///< text and list: what is allowed; empty allows anything
  std::optional<std::string> fallback;  ///< what an absent key means, written as in a file; none: the key is required
  bool whole = false;     ///< numbers: only whole ones; who scales a value rounds it (the reader of the block refuses)
  bool optional = false;  ///< an absent key without fallback is allowed and stays absent
  std::string meaning;

  Parameter or_else(std::string text) && {
    fallback = std::move(text);
    return std::move(*this);
  }
  Parameter in_whole_numbers() && {
    whole = true;
    return std::move(*this);
  }
  Parameter if_given() && {
    optional = true;
    return std::move(*this);
  }
};

/// What a number may be, in words: "0.001 to 1000 MPa", "at least 0", "any number".
std::string allowed_range(const Parameter& parameter);

/// Declarations read like a table: number("yield_stress", "MPa", 1e-3, 1e5, "uniaxial yield stress").
Parameter number(std::string key, std::string unit, double lower, double upper, std::string meaning);
/// A number with unit whose dimension another key decides: read as the text that stands in the file.
Parameter quantity(std::string key, std::string meaning);
Parameter text(std::string key, std::string meaning, std::vector<std::string> choices = {});
Parameter flag(std::string key, std::string meaning);
Parameter list(std::string key, std::string meaning, std::vector<std::string> choices = {});

/// A table of an input file: `[path]`. A block may have variants, told apart by the value of its key `law`
/// (path "material", variant "j2"); adding a law to a family is adding one Block to the list of known blocks.
struct Block {
  std::string path;     ///< dotted: "cohesive.mode_I"; "" for keys at the top of the file
  std::string variant;  ///< value of `law` that selects this block; "" when the block has no variants
  std::string meaning;
  std::vector<Parameter> parameters;
  bool required =
      false;  ///< always there: when a file leaves it out, its keys take their fallbacks (error if one has none)
  bool repeated = false;  ///< written as [[path]], any number of times
};

/// What was read for one block: numbers already in consistent units, fallbacks filled in.
class Values {
 public:
  double number(std::string_view key) const;
  const std::string& text(std::string_view key) const;
  bool flag(std::string_view key) const;
  const std::vector<std::string>& list(std::string_view key) const;
  bool has(std::string_view key) const;

  const std::string& variant() const { return variant_; }
  /// "cut.toml:14:12" of the key (or of the block when the key is absent), to begin an InputError with.
  std::string where(std::string_view key) const;

 private:
  friend class BlockReader;
  std::string variant_;
  std::string place_;
  std::map<std::string, double, std::less<>> numbers_;
  std::map<std::string, std::string, std::less<>> texts_;
  std::map<std::string, bool, std::less<>> flags_;
  std::map<std::string, std::vector<std::string>, std::less<>> lists_;
  std::map<std::string, std::string, std::less<>> places_;
};

/// The candidate nearest to `word` in edit distance, if near enough to be worth suggesting.
std::optional<std::string> nearest(std::string_view word, std::span<const std::string> candidates);

}  // namespace kerf
