#include "toolpath/robot/dialect.hpp"

#include "acquisition/types/error.hpp"
#include "toolpath/robot/rapid.hpp"
#include "toolpath/robot/read_rapid.hpp"
#include "toolpath/robot/read_vplus.hpp"
#include "toolpath/robot/vplus.hpp"

namespace arris {

const std::vector<Dialect>& dialects() {
  static const std::vector<Dialect> all = {{"rapid", ".mod", write_rapid, read_rapid},
                                           {"vplus", ".v2", write_vplus, read_vplus}};
  return all;
}

const Dialect& dialect_from_name(const std::string& word) {
  std::string known;
  for (const Dialect& dialect : dialects()) {
    if (word == dialect.word) return dialect;
    known += (known.empty() ? "" : " or ") + std::string(dialect.word);
  }
  throw Error(Fault::kRecipe, "robot.controller = \"" + word + "\", need " + known);
}

void check_cell(const Dialect& dialect, const Cell& cell) {
  for (const bool dry_run : {false, true}) {
    Program program;
    program.cell = cell;
    program.name = name_of_program(cell, dry_run);
    if (!dry_run && !cell.spindle_output.empty())
      program.events.emplace_back(SetOutput{cell.spindle_output, false});
    (void)dialect.write(program, [](std::string_view) { return std::string(); });
  }
}

}  // namespace arris
