#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "models/base/parameter.hpp"

namespace kerf {

/// What a document holds, after every key was checked against the known blocks.
class Contents {
 public:
  bool has(std::string_view path) const;
  /// The block at `path`. Asserts that it is there: ask `has` for blocks that are not required.
  const Values& at(std::string_view path) const;
  /// All the repeats of a [[path]] block, in file order; empty when there are none.
  const std::vector<Values>& all(std::string_view path) const;

 private:
  friend class BlockReader;
  std::map<std::string, std::vector<Values>, std::less<>> blocks_;
};

/// A TOML file with a memory of where everything stands. Dimensional values are strings with a unit ("0.5 mm").
/// Copyable; a calibration patches a copy and reads it again through the same door.
class Document {
 public:
  /// Throws InputError (file:line:column) on unreadable files, TOML syntax, duplicate keys.
  static Document load(const std::filesystem::path& file);
  static Document parse(std::string_view toml, std::string name);

  /// Checks the whole document against `known` and returns its values. Throws InputError for an unknown, misspelt,
  /// missing or out-of-range key, a bare number where a unit is needed, a unit of the wrong dimension, and a table
  /// that no block declares; the message says where, what was found, what is allowed and the nearest valid name.
  Contents read(const std::vector<Block>& known) const;

  /// True when the file itself holds a key or table at this dotted path.
  bool has(std::string_view path) const;

  /// The text at this dotted path, if the file itself holds one there.
  std::optional<std::string> text_at(std::string_view path) const;

  /// Writes `value` (consistent units) at a dotted path such as "cohesive.mode_I.toughness", creating nothing: throws
  /// InputError naming the nearest known path when `path` is not a numeric parameter of a block in this document.
  void set_number(std::string_view path, double value, const std::vector<Block>& known);

  /// The declaration behind a dotted path, or throws InputError as above. `where` begins the message.
  static const Parameter& find_number(std::string_view path, const std::vector<Block>& known, std::string_view where);

  /// The same for a key of any kind that one word can hold, and for the `law` of a block with variants.
  static Parameter find_parameter(std::string_view path, const std::vector<Block>& known, std::string_view where);

  /// Writes a text, a quantity, a flag ("true") or a block's `law` as a file would hold it. Whether the word is allowed
  /// says the next `read`. Throws like `set_number`.
  void set_text(std::string_view path, const std::string& text, const std::vector<Block>& known);

  /// Adds the table at `path`, empty, if it is not there. Asserts that `known` declares it.
  void add_table(std::string_view path, const std::vector<Block>& known);

  /// Takes the key or table at `path` out, if it is there.
  void remove(std::string_view path);

  /// Canonical text, itself TOML (sorted keys, no comments): equal for documents that differ only in layout; used as a
  /// run's identity.
  std::string canonical() const;
  const std::string& name() const { return name_; }

 private:
  Document() = default;
  template <class Value>
  void set(std::string_view path, Value value_for, const std::vector<Block>& known);
  std::string name_;
  struct Tree;
  std::shared_ptr<const Tree> tree_;
};

}  // namespace kerf
