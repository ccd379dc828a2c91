#include "inverse/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <system_error>

#include "models/base/error.hpp"

namespace kerf::inverse {

ChildProcess::ChildProcess(const std::vector<std::string>& words, const std::filesystem::path& output) {
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));  // NOLINT: exec's signature
  argv.push_back(nullptr);
  const int out = ::open(output.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (out < 0) throw InputError(fmt::format("{}: cannot write: {}", output.string(), std::strerror(errno)));
  const int in = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  const pid_t parent = ::getpid();
  child_ = ::fork();
  if (child_ == 0) {  // other threads may hold any lock: nothing but system calls until exec
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(127);
    ::dup2(in, STDIN_FILENO);
    ::dup2(out, STDOUT_FILENO);
    ::dup2(out, STDERR_FILENO);
    ::execvp(argv[0], argv.data());
    ::_exit(127);
  }
  const int error = errno;
  ::close(in);
  ::close(out);
  if (child_ < 0) throw std::system_error(error, std::generic_category(), "cannot start a process");
  ::setpgid(child_, child_);  // whoever comes first
}

ChildProcess::~ChildProcess() {
  if (child_ < 0) return;
  kill_group();
  reap();
}

void ChildProcess::kill_group() {
  ::kill(-child_, SIGKILL);
}

ChildProcess::Outcome ChildProcess::reap() {
  int status = 0;
  while (::waitpid(child_, &status, 0) < 0 && errno == EINTR) {
  }
  child_ = -1;
  if (WIFSIGNALED(status)) return {End::killed_by_signal, WTERMSIG(status)};
  return {End::exited, WEXITSTATUS(status)};
}

double ChildProcess::processor_seconds() const {
  clockid_t clock{};
  timespec used{};
  if (::clock_getcpuclockid(child_, &clock) != 0 || ::clock_gettime(clock, &used) != 0) return 0;
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

ChildProcess::Outcome ChildProcess::wait(std::optional<double> seconds, const std::function<bool()>& stop) {
  constexpr int milliseconds_between_questions = 100;
  auto last_work = std::chrono::steady_clock::now();
  double worked = 0;
  const int watched = static_cast<int>(::syscall(SYS_pidfd_open, child_, 0));
  std::optional<End> killed;
  while (!killed) {
    pollfd ended{.fd = watched, .events = POLLIN, .revents = 0};
    if (::poll(&ended, 1, milliseconds_between_questions) > 0) break;
    const auto now = std::chrono::steady_clock::now();
    if (const double used = processor_seconds(); used > worked) {
      worked = used;
      last_work = now;
    }
    const double idle = std::chrono::duration<double>(now - last_work).count();
    if (stop && stop())
      killed = End::stopped;
    else if (seconds && (worked > *seconds || idle > *seconds))
      killed = End::timed_out;
  }
  if (watched >= 0) ::close(watched);
  if (killed) kill_group();
  Outcome outcome = reap();
  if (killed) outcome.end = *killed;
  return outcome;
}

}  // namespace kerf::inverse
