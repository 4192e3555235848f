#include "tests/bench/scale/child.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>

namespace arris::bench {
namespace {

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

[[noreturn]] void become(const std::vector<std::string>& words, int out) {
  ::dup2(out, 1);
  ::dup2(out, 2);
  std::vector<char*> argv;
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  ::execvp(argv[0], argv.data());
  ::_exit(127);
}

}  // namespace

Child run_child(const std::vector<std::string>& words) {
  Child child;
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) return child;
  const auto began = std::chrono::steady_clock::now();
  const pid_t pid = ::fork();
  if (pid == 0) become(words, ends[1]);
  ::close(ends[1]);
  std::array<char, 4096> part{};
  for (ssize_t n = 0; pid > 0 && (n = ::read(ends[0], part.data(), part.size())) > 0;)
    child.out.append(part.data(), static_cast<std::size_t>(n));
  ::close(ends[0]);
  int status = 0;
  rusage used{};
  if (pid < 0 || ::wait4(pid, &status, 0, &used) != pid) return child;
  child.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  child.cpu_s = seconds(used.ru_utime) + seconds(used.ru_stime);
  child.peak_mb = static_cast<double>(used.ru_maxrss) * 1024.0 / 1e6;
  child.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return child;
}

}  // namespace arris::bench
