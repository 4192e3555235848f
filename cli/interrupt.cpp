#include "cli/interrupt.hpp"

#include <csignal>

#include "acquisition/types/error.hpp"

namespace arris {
namespace {

// The one thing that a signal handler may touch.
volatile std::sig_atomic_t stop_asked = 0;

extern "C" void on_stop(int) {
  stop_asked = 1;
}

}  // namespace

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = on_stop;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
}

bool interrupted() {
  return stop_asked != 0;
}

void stop_if_interrupted() {
  if (interrupted()) throw Error(Fault::kInterrupted, "stopped on request; nothing half-written is left");
}

}  // namespace arris
