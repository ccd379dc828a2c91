#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

namespace kerf::inverse {

/// An append-only file of JSON lines that survives a kill at any instant: a line counts once it ends in a newline and
/// was flushed to the disk; a torn last line is cut off when the journal is opened. One process at a time may hold it.
class Journal {
 public:
  using Json = nlohmann::ordered_json;

  /// Opens or creates `file` and reads what it holds. Throws InputError when another process holds the journal, when
  /// the file cannot be opened, or when a line other than the last is damaged.
  explicit Journal(std::filesystem::path file);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// The lines that stood in the file when it was opened, in order.
  const std::vector<Json>& lines() const { return lines_; }

  /// Writes one line and returns when it is on the disk. Throws InputError when it cannot be written, as on a full
  /// disk; the file then ends with the line before. Not to be called by two threads at once.
  void append(const Json& line);

 private:
  void read();

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::int64_t size_ = 0;  ///< of what is known to be on the disk
  std::vector<Json> lines_;
};

}  // namespace kerf::inverse
