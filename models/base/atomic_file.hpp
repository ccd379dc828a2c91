#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace kerf {

/// Replaces `file` by `content` in one step (temporary file beside it, fsync, rename): a reader sees the old or the new
/// content, never a part. Creates missing parent folders. Throws InputError when the place cannot be written.
void write_atomically(const std::filesystem::path& file, std::string_view content);

/// The whole content of a file. Throws InputError when it is not a readable regular file.
std::string read_file(const std::filesystem::path& file);

/// SHA-256 as 64 lower-case hexadecimal digits.
std::string sha256(std::string_view content);

}  // namespace kerf
