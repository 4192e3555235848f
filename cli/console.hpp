#pragma once

#include <string>
#include <string_view>

namespace arris::console {

/// A line of the result, on stdout: what was asked for, and nothing else.
void print(std::string_view line);

/// "arris: <line>" on stderr; line breaks and control characters of file names become spaces, so it stays one
/// line.
void complain(std::string_view line);

/// A remark on stderr that is not an error ("arris: note: ..."); shown in a pipe as well.
void note(std::string_view line);

/// Writes out what is buffered. Throws Error(kInput) when stdout cannot take it (a full disk); a reader that
/// left early (arris info x | head) is not an error.
void flush();

/// One line on stderr that says how far a job is; shown on a terminal only and wiped when the job ends.
class Progress {
 public:
  /// shown: stderr is a terminal, unless told otherwise
  Progress();
  explicit Progress(bool shown) : shown_(shown) {}
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// "3/7 aligning".  Also the place where Ctrl-C is heard: throws Error(kInterrupted).
  void stage(int step, int steps, std::string_view what);
  /// Any text in the place of the line before, cut at the terminal's width.
  void show(std::string_view text);

 private:
  bool shown_ = false;
  bool dirty_ = false;
};

}  // namespace arris::console
