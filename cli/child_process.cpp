#include "cli/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>

#include "acquisition/types/error.hpp"

namespace arris {
namespace {

constexpr std::size_t kMostSaid = 65536;
constexpr const char* kThisProgram = "/proc/self/exe";  // stays the same when the file is replaced meanwhile

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

[[noreturn]] void refuse_start(int code) {
  throw Error(Fault::kInput, {.what = "no further process can be started",
                              .found = std::strerror(code),
                              .needed = "one process a scan that runs",
                              .next = "give fewer --jobs, or end other programs"});
}

/// In the child, between fork and exec: only calls that are safe there, since the parent may have threads.
[[noreturn]] void become(char* const* argv, pid_t parent, int stderr_fd) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);  // it died before it could be heard
  const int null_fd = ::open("/dev/null", O_RDWR);
  ::dup2(null_fd, STDIN_FILENO);
  ::dup2(null_fd, STDOUT_FILENO);
  ::dup2(stderr_fd, STDERR_FILENO);
  ::execv(kThisProgram, argv);
  ::_exit(1);
}

/// Takes what is there; false at the end, when the child has gone.
bool read_some(int fd, std::string& said) {
  std::array<char, 4096> part{};
  const ssize_t count = ::read(fd, part.data(), part.size());
  if (count > 0) said.append(part.data(), static_cast<std::size_t>(count));
  if (said.size() > kMostSaid) said.erase(0, said.size() - kMostSaid);
  return count > 0 || (count < 0 && errno == EINTR);
}

ChildEnd reap(pid_t pid) {
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  ChildEnd end;
  if (WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  return end;
}

}  // namespace

ChildPool::~ChildPool() {
  ask_to_stop();
  while (running() > 0) (void)wait(-1);
}

void ChildPool::start(int id, const std::vector<std::string>& arguments) {
  std::string name = "arris";
  std::vector<std::string> words = arguments;
  std::vector<char*> argv{name.data()};
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) refuse_start(errno);
  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  if (pid == 0) become(argv.data(), parent, ends[1]);
  const int failure = errno;
  ::close(ends[1]);
  if (pid < 0) {
    ::close(ends[0]);
    refuse_start(failure);
  }
  children_.push_back({id, pid, ends[0], now_s(), {}, false});
}

int ChildPool::kill_late(int timeout_ms) {
  for (Child& child : children_) {
    if (most_s_ <= 0.0 || child.late) continue;
    const double left_ms = std::ceil(1e3 * (child.began_s + most_s_ - now_s()));
    child.late = left_ms <= 0.0;
    if (child.late)
      ::kill(child.pid, SIGKILL);
    else if (timeout_ms < 0 || left_ms < timeout_ms)
      timeout_ms = static_cast<int>(std::min(left_ms, 1e9));
  }
  return timeout_ms;
}

std::vector<ChildEnd> ChildPool::wait(int timeout_ms) {
  timeout_ms = kill_late(timeout_ms);
  std::vector<pollfd> polled;
  for (const Child& child : children_) polled.push_back({child.stderr_fd, POLLIN, 0});
  std::vector<ChildEnd> ended;
  if (::poll(polled.data(), polled.size(), timeout_ms) <= 0) return ended;
  std::vector<Child> still;
  for (std::size_t i = 0; i < children_.size(); ++i) {
    Child& child = children_[i];
    if (polled[i].revents == 0 || read_some(child.stderr_fd, child.said)) {
      still.push_back(std::move(child));
      continue;
    }
    ::close(child.stderr_fd);  // its end of the pipe is closed: it has gone
    ended.push_back(reap(child.pid));
    ended.back().id = child.id;
    ended.back().said = std::move(child.said);
    ended.back().wall_s = now_s() - child.began_s;
    if (child.late && ended.back().signal == SIGKILL) ended.back().late_s = most_s_;
  }
  children_ = std::move(still);
  return ended;
}

void ChildPool::ask_to_stop() const {
  for (const Child& child : children_) ::kill(child.pid, SIGTERM);
}

std::vector<int> ChildPool::running_ids() const {
  std::vector<int> ids;
  for (const Child& child : children_) ids.push_back(child.id);
  return ids;
}

}  // namespace arris
