#pragma once

#include <map>
#include <string>
#include <vector>

#include "toolpath/robot/read_tokens.hpp"

namespace arris::rapid_reader {

using program_reader::Comment;
using program_reader::Name;
using program_reader::Source;

enum class ValueKind { kNumber, kUnused, kText, kTruth, kList };

struct Value {
  ValueKind kind = ValueKind::kNumber;
  double number = 0.0;
  bool truth = false;
  std::vector<Value> items;
  int line = 0;
};

struct Declaration {
  std::string storage, type, written;
  Value value;
  bool has_value = false;
  int line = 0;
};

enum class StatementKind { kConf, kMove, kSet, kWait, kIf, kPrint, kExit, kRaise, kCall };

struct Statement {
  StatementKind kind = StatementKind::kCall;
  int line = 0;
  bool joint = false;  ///< kMove: MoveJ; kConf: ConfJ
  bool on = false;     ///< kConf
  Name target;         ///< kMove: of a named target; empty with a literal one
  Value literal;       ///< kMove
  double offset_mm[3] = {0.0, 0.0, 0.0};
  Name speed, zone, tool, work;
  Name signal;  ///< kSet, kWait; kCall: the procedure; kIf: the flag
  Name flag;    ///< kWait
  int value = 0;
  double timeout_s = 0.0;
  std::vector<Statement> body;  ///< kIf
};

struct Procedure {
  std::vector<Statement> body, on_error;
  int line = 0;
};

struct Module {
  std::string name;
  std::map<std::string, Declaration> data;  ///< by name in lower case
  std::map<std::string, Procedure> procedures;
  std::vector<Comment> comments;
};

/// Text to tree, by the grammar of read_rapid.hpp; throws Error(kInput) with the line.
[[nodiscard]] Module parse_rapid(std::string_view text, const std::string& source);

}  // namespace arris::rapid_reader
