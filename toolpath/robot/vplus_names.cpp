#include "toolpath/robot/vplus_names.hpp"

#include <algorithm>
#include <optional>

#include "acquisition/types/error.hpp"
#include "toolpath/robot/names.hpp"

namespace arris {
namespace {

using std::string;

constexpr std::size_t kLongestName = 15;

// Words of V+ that a variable or program cannot have as its name; `p` is the program's own.
const NameRules kVplus = {
    .language = "V+",
    .signs = "._",
    .in_words = "letters, digits, points and underscores",
    .longest = kLongestName,
    .reserved =
        {"abort",    "above",     "abs",        "accel",     "align",     "all",          "always",
         "and",      "any",       "appro",      "appros",    "asc",       "atan2",        "attach",
         "auto",     "band",      "base",       "below",     "belt",      "bor",          "brake",
         "break",    "bxor",      "by",         "call",      "calls",     "case",         "close",
         "coarse",   "com",       "cos",        "cpoff",     "cpon",      "cycle",        "decompose",
         "defined",  "delay",     "depart",     "departs",   "dest",      "detach",       "disable",
         "distance", "do",        "drive",      "dry.run",   "duration",  "dx",           "dy",
         "dz",       "else",      "enable",     "end",       "error",     "execute",      "exit",
         "false",    "fine",      "flip",       "for",       "force",     "fract",        "frame",
         "free",     "global",    "goto",       "halt",      "hand",      "here",         "hour.meter",
         "id",       "identical", "if",         "ignore",    "in",        "inrange",      "int",
         "inverse",  "invert",    "iostat",     "ips",       "last",      "latch",        "latched",
         "lefty",    "len",       "loc",        "local",     "lock",      "max",          "mc",
         "mcs",      "min",       "mmps",       "mod",       "monitor",   "move",         "movef",
         "moves",    "movesf",    "movest",     "movet",     "multiple",  "next",         "noflip",
         "nonull",   "noop",      "not",        "null",      "of",        "off",          "on",
         "open",     "or",        "outside",    "parameter", "pause",     "payload",      "pi",
         "pos",      "power",     "prompt",     "random",    "react",     "reacte",       "reacti",
         "read",     "ready",     "real",       "relax",     "release",   "reset",        "return",
         "returne",  "righty",    "robot",      "rx",        "ry",        "rz",           "run",
         "runsig",   "scale",     "select",     "set",       "shift",     "sig",          "sig.ins",
         "sign",     "signal",    "signals",    "sin",       "single",    "solve.angles", "speed",
         "sqr",      "sqrt",      "state",      "status",    "step",      "stop",         "switch",
         "tas",      "task",      "then",       "time",      "timer",     "to",           "tool",
         "tps",      "trans",     "true",       "type",      "unidirect", "until",        "val",
         "value",    "wait",      "wait.event", "while",     "world",     "write",        "xor",
         "p"},
    .numbered = {},
    .predefined = {"null"}};

// A whole number without sign or leading zero, of at most 4 digits.
std::optional<int> signal_of(const string& name) {
  if (name.empty() || name.size() > 4 || name.front() == '0') return std::nullopt;
  int number = 0;
  for (char c : name) {
    if (c < '0' || c > '9') return std::nullopt;
    number = 10 * number + (c - '0');
  }
  return number;
}

void check_signal(const char* field, const string& name, int least, int most) {
  const int number = signal_of(name).value_or(-1);
  if (!name.empty() && (number < least || number > most))
    throw Error(Fault::kRecipe, string("cell.") + field + " = \"" + name +
                                    "\", need for V+ the number of a digital signal, \"" +
                                    std::to_string(least) + "\" to \"" + std::to_string(most) + "\"");
}

// "a, b, c"; throws unless they are three names.
void check_points(const string& points, NameCheck& names) {
  std::size_t begin = 0;
  for (int k = 0; k < 3; ++k) {
    const std::size_t end = k < 2 ? points.find(", ", begin) : points.size();
    if (end == string::npos)
      throw Error(Fault::kRecipe,
                  "cell.work_points = \"" + points + "\", need three taught points as in \"pa, pb, pc\"");
    names.take("work_points", points.substr(begin, end - begin));
    begin = end + 2;
  }
}

}  // namespace

string vplus_part_name(const string& program, const string& suffix) {
  string name = program + "." + suffix;
  if (name.size() > kLongestName)
    throw Error(Fault::kRecipe, "cell.program_name makes the V+ program \"" + name + "\", need at most " +
                                    std::to_string(kLongestName) +
                                    " characters: shorten it, \"Dry\" and numbers of parts come behind");
  return name;
}

void check_vplus_names(const Program& program) {
  const Cell& cell = program.cell;
  NameCheck names(kVplus);
  names.take("program_name", program.name);
  names.take("tool_name", cell.tool_name, !cell.define_tool);
  names.take("work_name", cell.work_name, !cell.define_work);
  if (!cell.work_points.empty()) check_points(cell.work_points, names);
  check_signal("spindle_output", cell.spindle_output, 1, 999);
  check_signal("spindle_ready", cell.spindle_ready, 1001, 1999);
}

}  // namespace arris
