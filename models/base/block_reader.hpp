#pragma once

#include <string>
#include <vector>

#include "models/base/document_tree.hpp"

namespace kerf {

/// Reads one document against the blocks that may stand in it. First every table and key is looked up, so that a slip
/// of the pen is reported as what it is and not as a missing key; then every declared key is read.
class BlockReader {
 public:
  BlockReader(const Node& root, const std::string& name, const std::vector<Block>& known)
      : root_(root), name_(name), known_(known) {}

  Contents read() const;

  /// The parameters that hold for this table of block `path`: the common ones and those of its `law`.
  std::vector<const Parameter*> parameters_of(const Node& table, std::string_view path) const;

 private:
  std::vector<const Block*> blocks_at(std::string_view path) const;
  std::vector<std::string> variants_at(std::string_view path) const;
  std::vector<std::string> children_of(std::string_view path) const;
  bool is_branch(std::string_view path) const;
  std::string law_of(const Node& table, std::string_view path) const;

  void check_names(const Node& table, const std::string& path) const;
  void check_child(const Node& child, const std::string& path) const;
  [[noreturn]] void refuse_name(const std::string& key, const Node& value, const std::string& path,
                                std::vector<std::string> keys) const;

  void read_block(const Block& block, Contents& contents) const;
  Values read_table(const Node& table, std::string_view path) const;
  void read_parameter(const Parameter& parameter, const Node& table, std::string_view path, Values& values) const;
  void store(const Parameter& parameter, const Node& node, Values& values) const;

  std::string place(int line, int column) const;

  const Node& root_;
  const std::string& name_;
  const std::vector<Block>& known_;
};

}  // namespace kerf
