#include "tests/bench/scale/child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <fstream>

namespace arris::bench {
namespace {

constexpr int kLookEveryMs = 4;
constexpr int kNoSuchProgram = 127;  // as a shell says it

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

/// Resident memory of a process that is in no file; 0 when it has ended.
double anonymous_mb(pid_t pid) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string word; status >> word;)
    if (double kib = 0.0; word == "RssAnon:" && status >> kib) return kib * 1024.0 / 1e6;
  return 0.0;
}

/// Starts words[0] with its stdout and stderr at `out`; an error number, 0 when it runs.
int start(const std::vector<std::string>& words, int out, pid_t& pid) {
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, out, 1);
  ::posix_spawn_file_actions_adddup2(&actions, out, 2);
  std::vector<char*> argv;
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  const int failure = ::posix_spawnp(&pid, argv[0], &actions, nullptr, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  return failure;
}

}  // namespace

Child run_child(const std::vector<std::string>& words) {
  Child child;
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return child;
  const auto began = std::chrono::steady_clock::now();
  pid_t pid = 0;
  const int failure = start(words, ends[1], pid);
  ::close(ends[1]);
  if (failure != 0) {
    ::close(ends[0]);
    child.code = failure == ENOENT ? kNoSuchProgram : -1;
    return child;
  }
  std::array<char, 4096> part{};
  for (pollfd printed{ends[0], POLLIN, 0};;) {
    child.anonymous_mb = std::max(child.anonymous_mb, anonymous_mb(pid));
    if (::poll(&printed, 1, kLookEveryMs) == 0) continue;
    const ssize_t n = ::read(ends[0], part.data(), part.size());
    if (n <= 0) break;
    child.out.append(part.data(), static_cast<std::size_t>(n));
  }
  ::close(ends[0]);
  int status = 0;
  rusage used{};
  if (::wait4(pid, &status, 0, &used) != pid) return child;
  child.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  child.cpu_s = seconds(used.ru_utime) + seconds(used.ru_stime);
  child.peak_mb = static_cast<double>(used.ru_maxrss) * 1024.0 / 1e6;
  child.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return child;
}

}  // namespace arris::bench
