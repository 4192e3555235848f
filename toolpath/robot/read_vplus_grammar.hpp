#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "toolpath/robot/read_tokens.hpp"

namespace arris::vplus_reader {

using program_reader::Comment;
using program_reader::Name;
using program_reader::Source;

enum class StatementKind {
  kAuto,
  kSelect,
  kAttach,
  kTrap,
  kSet,
  kTool,
  kContinuous,
  kSpeed,
  kMove,
  kDepart,
  kBreak,
  kSignal,
  kTimer,
  kWait,
  kIf,
  kPrint,
  kHalt,
  kCall
};

struct Statement {
  StatementKind kind = StatementKind::kBreak;
  int line = 0;
  Name name;                      ///< kAuto, kSet, kTool, kTrap, kCall; kMove: the frame, may be empty
  Name point;                     ///< kMove: of a named location; empty with a literal one
  bool literal = false;           ///< kSet, kMove: `trans` counts, else kSet goes by `points`
  std::array<double, 6> trans{};  ///< x, y, z, yaw, pitch, roll: mm and degrees
  std::array<Name, 4> points;     ///< kSet: FRAME(a, b, c, d)
  bool joint = false;             ///< kMove, kDepart: not along a straight line
  bool on = true;                 ///< kAttach: not DETACH; kSignal, kWait, kIf: the signal, else its opposite
  double away_mm = 0.0;           ///< kMove: back along the tool's z (APPRO); kDepart
  double speed_mm_s = 0.0, turn_percent = 0.0;  ///< kSpeed; 0: not said
  int number = 0;                               ///< kSelect, kSignal, kWait, kIf: which
  int timer = 0;                                ///< kTimer, kWait; 0: waits for ever
  double timeout_s = 0.0;                       ///< kWait
  std::vector<Statement> body;                  ///< kIf
};

struct Routine {
  std::string written;
  std::vector<Statement> body;
  int line = 0, end_line = 0;
};

struct File {
  std::map<std::string, Routine> routines;  ///< by name in lower case
  std::vector<Comment> comments;
};

/// Text to tree, by the grammar of read_vplus.hpp; throws Error(kInput) with the line.
[[nodiscard]] File parse_vplus(std::string_view text, const std::string& file);

/// As errors call the language.
extern const char* const kVplus;

}  // namespace arris::vplus_reader
