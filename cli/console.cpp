#include "cli/console.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "acquisition/types/error.hpp"
#include "cli/interrupt.hpp"

namespace arris::console {
namespace {

std::string one_line(std::string_view text) {
  std::string line(text);
  for (char& c : line)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  return line;
}

/// After a write to stdout that failed: the reader left (no error), or the disk is full.
void check_stdout(bool good) {
  if (good || errno == EPIPE) return;
  throw Error(Fault::kInput, {.what = "the output cannot be written",
                              .where = "stdout",
                              .found = std::strerror(errno),
                              .needed = "room for all of it",
                              .next = "make room, or send it elsewhere, and give the command again"});
}

void write_error(const std::string& line) {
  std::fwrite(line.data(), 1, line.size(), stderr);
}

/// Columns of the terminal on stderr; 80 when it does not say.
std::size_t terminal_columns() {
  winsize size = {};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col : 80;
}

/// At most `columns` characters of UTF-8: a line that wraps could not be wiped.
std::string clipped(const std::string& line, std::size_t columns) {
  std::size_t seen = 0;
  for (std::size_t i = 0; i < line.size(); ++i)
    if ((static_cast<unsigned char>(line[i]) & 0xC0) != 0x80 && ++seen > columns) return line.substr(0, i);
  return line;
}

}  // namespace

void print(std::string_view line) {
  const std::string text = std::string(line) + '\n';
  check_stdout(std::fwrite(text.data(), 1, text.size(), stdout) == text.size());
}

void complain(std::string_view line) {
  write_error("arris: " + one_line(line) + "\n");
}

void note(std::string_view line) {
  write_error("arris: note: " + one_line(line) + "\n");
}

void flush() {
  check_stdout(std::fflush(stdout) == 0);
}

Progress::Progress() : shown_(::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (dirty_) write_error("\r\033[K");
}

void Progress::stage(int step, int steps, std::string_view what) {
  stop_if_interrupted();
  show(std::to_string(step) + "/" + std::to_string(steps) + " " + std::string(what));
}

void Progress::show(std::string_view text) {
  if (!shown_) return;
  write_error("\r\033[K" + clipped(one_line(text), terminal_columns() - 1));
  dirty_ = true;
}

}  // namespace arris::console
