#include "inverse/journal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include "models/base/error.hpp"

namespace kerf::inverse {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const char* what) {
  throw std::system_error(errno, std::generic_category(), fmt::format("{}: {}", file.string(), what));
}

std::string read_all(int descriptor, const std::filesystem::path& file) {
  std::string content;
  std::array<char, 1 << 16> buffer;
  while (true) {
    const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(file, "cannot read the journal");
    if (count == 0) return content;
    content.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace

Journal::Journal(std::filesystem::path file) : file_(std::move(file)) {
  descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (descriptor_ < 0)
    throw InputError(fmt::format("{}: cannot open the journal: {}", file_.string(), std::strerror(errno)));
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    ::close(descriptor_);
    throw InputError(
        fmt::format("{}: another process is writing this journal; wait for it to end or stop it", file_.string()));
  }
  try {
    read();
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

Journal::~Journal() {
  ::close(descriptor_);
}

void Journal::read() {
  const std::string content = read_all(descriptor_, file_);
  std::size_t begin = 0;
  while (begin < content.size()) {
    const std::size_t end = content.find('\n', begin);
    const bool torn = end == std::string::npos;
    Json line = torn ? Json(Json::value_t::discarded)
                     : Json::parse(content.begin() + static_cast<std::ptrdiff_t>(begin),
                                   content.begin() + static_cast<std::ptrdiff_t>(end), nullptr, false);
    if (line.is_discarded()) {
      if (!torn && end + 1 < content.size())
        throw InputError(fmt::format("{}:{}: this line of the journal is damaged; start again in another folder",
                                     file_.string(), lines_.size() + 1));
      if (::ftruncate(descriptor_, static_cast<off_t>(begin)) != 0) fail(file_, "cannot cut off a torn line");
      return;
    }
    lines_.push_back(std::move(line));
    begin = end + 1;
    size_ = static_cast<std::int64_t>(begin);
  }
}

void Journal::append(const Json& line) {
  const auto refuse = [&] {
    const int cause = errno;
    static_cast<void>(::ftruncate(descriptor_, size_) == 0);  // else the torn line is cut off at the next opening
    throw InputError(fmt::format("{}: cannot write the journal: {}; every line before is kept", file_.string(),
                                 std::strerror(cause)));
  };
  const std::string text = line.dump() + '\n';
  for (std::size_t written = 0; written < text.size();) {
    const ssize_t count = ::write(descriptor_, text.data() + written, text.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuse();
    written += static_cast<std::size_t>(count);
  }
  if (::fsync(descriptor_) != 0) refuse();
  size_ += static_cast<std::int64_t>(text.size());
}

}  // namespace kerf::inverse
