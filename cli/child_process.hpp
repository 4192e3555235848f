#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace arris {

/// How a child ended, and what it said on stderr.
struct ChildEnd {
  int id = 0;           ///< as given to start()
  int exit_code = -1;   ///< -1: a signal ended it
  int signal = 0;       ///< 0: it ended by itself
  std::string said;     ///< stderr, the last 64 KiB at most
  double wall_s = 0.0;  ///< from start to end
  double late_s = 0.0;  ///< the time that it was killed for running longer than; 0: it was not
};

/// Children that run this same program. They die with it, however it dies, and their stdout is dropped.
class ChildPool {
 public:
  /// A child that runs longer than `most_s` is killed by wait(), for one that hangs hears no SIGTERM; 0:
  /// none.
  explicit ChildPool(double most_s = 0.0) : most_s_(most_s) {}
  ~ChildPool();  ///< asks those that still run to stop, and waits for them
  ChildPool(const ChildPool&) = delete;
  ChildPool& operator=(const ChildPool&) = delete;

  /// Starts this program with `arguments` (its own name not among them); `id` comes back in ChildEnd.
  ///   throws  Error(kInput): the machine gives no further process
  void start(int id, const std::vector<std::string>& arguments);

  /// Waits until a child ends or is late, a signal arrives, or the time is over; returns those that ended, by
  /// id.
  [[nodiscard]] std::vector<ChildEnd> wait(int timeout_ms);

  /// SIGTERM to all: each ends its stage and removes what is half-written.
  void ask_to_stop() const;

  [[nodiscard]] std::size_t running() const { return children_.size(); }
  [[nodiscard]] std::vector<int> running_ids() const;

 private:
  struct Child {
    int id = 0;
    pid_t pid = 0;
    int stderr_fd = -1;
    double began_s = 0.0;
    std::string said;
    bool late = false;
  };
  /// Kills who is late; returns how long to wait until the next one is, `timeout_ms` at most (-1: for ever).
  int kill_late(int timeout_ms);

  double most_s_;
  std::vector<Child> children_;
};

}  // namespace arris
