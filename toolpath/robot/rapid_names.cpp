#include "toolpath/robot/rapid_names.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "acquisition/types/error.hpp"

namespace arris {
namespace {

using std::string;

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

string lower(string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

// The reserved words of RAPID, and the types and instructions that the module uses.
const std::set<string> kReserved = {
    "alias",     "and",     "backward", "case",     "connect",   "const",     "default",   "div",
    "do",        "else",    "elseif",   "endfor",   "endfunc",   "endif",     "endmodule", "endproc",
    "endrecord", "endtest", "endtrap",  "endwhile", "error",     "exit",      "false",     "for",
    "from",      "func",    "goto",     "if",       "inout",     "local",     "mod",       "module",
    "nostepin",  "not",     "noview",   "or",       "pers",      "proc",      "raise",     "readonly",
    "record",    "retry",   "return",   "step",     "sysmodule", "test",      "then",      "to",
    "task",      "trap",    "true",     "trynext",  "undo",      "var",       "viewonly",  "while",
    "with",      "xor",     "tooldata", "wobjdata", "speeddata", "zonedata",  "robtarget", "bool",
    "num",       "string",  "movej",    "movel",    "setdo",     "waitdi",    "confj",     "confl",
    "tpwrite",   "fine",    "offs",     "tool0",    "wobj0",     "breadylate"};

// p12, vPath3, zPath4, part5: targets, speeds, zones and procedures of the module.
bool is_ours(const string& name) {
  for (const char* stem : {"p", "vpath", "zpath", "part"}) {
    const string prefix = stem;
    if (name.size() > prefix.size() && name.compare(0, prefix.size(), prefix) == 0 &&
        std::all_of(name.begin() + static_cast<std::ptrdiff_t>(prefix.size()), name.end(), is_digit))
      return true;
  }
  return false;
}

void check_name(const string& field, const string& name) {
  const bool shaped =
      !name.empty() && name.size() <= 32 && is_letter(name.front()) &&
      std::all_of(name.begin(), name.end(), [](char c) { return is_letter(c) || is_digit(c) || c == '_'; });
  if (!shaped)
    throw Error(Fault::kRecipe,
                "cell." + field + " = \"" + name +
                    "\", need a RAPID name: a letter, then letters, digits and underscores, at most 32");
  if (kReserved.count(lower(name)) > 0 || is_ours(lower(name)))
    throw Error(Fault::kRecipe,
                "cell." + field + " = \"" + name + "\", need a name that RAPID and the program leave free");
}

}  // namespace

void check_rapid_names(const Program& program) {
  const Cell& cell = program.cell;
  std::set<string> used;
  const auto take = [&](const string& field, const string& name, bool predefined_allowed) {
    const bool predefined = lower(name) == "tool0" || lower(name) == "wobj0";
    if (!(predefined && predefined_allowed)) check_name(field, name);
    if (!used.insert(lower(name)).second)
      throw Error(Fault::kRecipe,
                  "cell." + field + " = \"" + name + "\", need a name that no other field has");
  };
  take("program_name", program.name, false);
  take("entry_name", cell.entry_name, false);
  take("tool_name", cell.tool_name, !cell.define_tool);
  take("work_name", cell.work_name, !cell.define_work);
  if (!cell.spindle_output.empty()) take("spindle_output", cell.spindle_output, false);
  if (!cell.spindle_ready.empty()) take("spindle_ready", cell.spindle_ready, false);
}

}  // namespace arris
