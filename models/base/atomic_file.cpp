#include "models/base/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/evp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <system_error>

#include "models/base/error.hpp"

namespace kerf {
namespace {

class OpenFile {
 public:
  explicit OpenFile(int descriptor) : descriptor_(descriptor) {}
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  bool is_open() const { return descriptor_ >= 0; }
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

bool write_all(int descriptor, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(descriptor, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& cause) {
  throw InputError(fmt::format("{}: cannot write: {}", file.string(), cause));
}

}  // namespace

void write_atomically(const std::filesystem::path& file, std::string_view content) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) refuse(file, failure.message());

  std::string temporary = (folder / fmt::format(".{}.XXXXXX", file.filename().string())).string();
  {
    const OpenFile out(::mkostemp(temporary.data(), O_CLOEXEC));
    if (!out.is_open()) refuse(file, std::strerror(errno));
    constexpr mode_t readable_by_all = 0644;
    if (::fchmod(out.descriptor(), readable_by_all) != 0 || !write_all(out.descriptor(), content) ||
        ::fsync(out.descriptor()) != 0) {
      const std::string cause = std::strerror(errno);
      ::unlink(temporary.c_str());
      refuse(file, cause);
    }
  }
  std::filesystem::rename(temporary, file, failure);
  if (failure) {
    ::unlink(temporary.c_str());
    refuse(file, failure.message());
  }
  // The rename itself lasts only once the folder's entry is on disk.
  if (const OpenFile entry(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)); entry.is_open())
    ::fsync(entry.descriptor());
}

std::string read_file(const std::filesystem::path& file) {
  std::error_code failure;
  const auto status = std::filesystem::status(file, failure);
  if (!std::filesystem::exists(status)) throw InputError(fmt::format("{}: there is no such file", file.string()));
  if (std::filesystem::is_directory(status))
    throw InputError(fmt::format("{}: is a folder; a file belongs here", file.string()));
  std::ifstream in(file, std::ios::binary);
  std::string content{std::istreambuf_iterator<char>(in), {}};
  if (!in) throw InputError(fmt::format("{}: cannot be read", file.string()));
  return content;
}

std::string sha256(std::string_view content) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  if (EVP_Digest(content.data(), content.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("SHA-256 is not available from libcrypto");
  std::string hex;
  for (unsigned int i = 0; i < size; ++i) hex += fmt::format("{:02x}", digest[i]);
  return hex;
}

}  // namespace kerf
