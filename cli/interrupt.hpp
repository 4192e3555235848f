#pragma once

namespace arris {

/// From here on Ctrl-C (SIGINT) and SIGTERM ask the program to stop at the end of the stage it is in, so that
/// what it was writing is removed; a second one stops it at once. A reader of stdout that leaves no longer
/// kills it (SIGPIPE).
void catch_interrupts();

[[nodiscard]] bool interrupted();

/// Throws Error(kInterrupted), exit code 130, when a stop was asked for. Called between stages.
void stop_if_interrupted();

}  // namespace arris
