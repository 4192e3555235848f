#include "toolpath/robot/read_vplus_grammar.hpp"

#include <set>

namespace arris::vplus_reader {

const char* const kVplus = "V+";

namespace {

using namespace program_reader;  // NOLINT: tokens and cursor

const std::set<std::string> kWords = {
    ".program", ".end",  "auto",   "loc",    "select",  "robot",  "attach", "detach", "reacte",
    "set",      "trans", "frame",  "tool",   "cpon",    "always", "speed",  "mmps",   "move",
    "moves",    "appro", "appros", "depart", "departs", "break",  "signal", "timer",  "wait",
    "sig",      "or",    "if",     "not",    "then",    "end",    "type",   "halt",   "call"};

const Language kLanguage = {.name = kVplus,
                            .comment = ';',
                            .signs = {"(", ")", ",", ":", "=", ">", "-"},
                            .in_names = "._",
                            .before_names = ".",
                            .longest_name = 15,
                            .longest_line = 128,
                            .by_lines = true};

class Parser : private Cursor {
 public:
  Parser(std::string_view text, const std::string& file)
      : Cursor(tokens_of(text, kLanguage, file), {file, kLanguage.name}) {}

  File run() {
    do routine();
    while (is_word(".program"));
    if (here().kind != TokenKind::kEnd) wrong("the word .program or the end of the text");
    file_.comments = std::move(tokens_.comments);
    return std::move(file_);
  }

 private:
  void end_of_line() {
    if (here().kind != TokenKind::kLine) wrong("the end of the line");
    while (here().kind == TokenKind::kLine) take();
  }

  Name name() {
    if (here().kind != TokenKind::kName || kWords.count(here().text) > 0) wrong("a name");
    const Token& token = take();
    return {token.text, token.written};
  }

  int count(int most) {
    if (here().kind != TokenKind::kNumber || here().text.size() > 4 || here().text.front() == '0' ||
        here().text.find('.') != std::string::npos || here().number > most)
      wrong("a whole number from 1 to " + std::to_string(most));
    return static_cast<int>(take().number);
  }

  void routine() {
    Routine found;
    found.line = here().line;
    word(".program");
    const Name named = name();
    found.written = named.written;
    sign("(");
    sign(")");
    end_of_line();
    while (is_word("auto")) {
      found.body.push_back(local());
      end_of_line();
    }
    found.body = statements(std::move(found.body));
    found.end_line = here().line;
    word(".end");
    end_of_line();
    if (!file_.routines.emplace(named.key, found).second)
      refuse(source_, found.line, "a second " + named.written, "each name once");
  }

  std::vector<Statement> statements(std::vector<Statement> all = {}) {
    while (!is_word(".end") && !is_word("end") && here().kind != TokenKind::kEnd) {
      all.push_back(statement());
      end_of_line();
    }
    return all;
  }

  Statement started(StatementKind kind) {
    Statement out;
    out.kind = kind;
    out.line = here().line;
    return out;
  }

  Statement local() {
    Statement out = started(StatementKind::kAuto);
    take();
    word("loc");
    out.name = name();
    return out;
  }

  Statement statement() {
    if (is_word("set")) return assignment();
    if (is_word("speed")) return speed();
    if (is_word("signal")) return signal();
    if (is_word("timer")) return timer();
    if (is_word("wait")) return wait();
    if (is_word("if")) return conditional();
    if (is_word("move") || is_word("moves") || is_word("appro") || is_word("appros")) return move();
    if (is_word("depart") || is_word("departs")) return depart();
    if (is_word("select") || is_word("attach") || is_word("detach")) return robot();
    if (is_word("reacte") || is_word("tool") || is_word("call")) return named();
    return plain();
  }

  Statement plain() {
    Statement out = started(StatementKind::kBreak);
    if (skip_word("break")) return out;
    if (skip_word("halt")) {
      out.kind = StatementKind::kHalt;
    } else if (skip_word("cpon")) {
      out.kind = StatementKind::kContinuous;
      word("always");
    } else if (skip_word("type")) {
      out.kind = StatementKind::kPrint;
      if (here().kind != TokenKind::kText) wrong("a string");
      take();
    } else {
      wrong("an instruction of moves, signals and waits");
    }
    return out;
  }

  Statement named() {
    Statement out = started(is_word("reacte") ? StatementKind::kTrap
                            : is_word("tool") ? StatementKind::kTool
                                              : StatementKind::kCall);
    take();
    out.name = name();
    if (out.kind == StatementKind::kCall) {
      sign("(");
      sign(")");
    }
    return out;
  }

  Statement robot() {
    const bool select = is_word("select");
    Statement out = started(select ? StatementKind::kSelect : StatementKind::kAttach);
    out.on = !is_word("detach");
    take();
    if (select) {
      word("robot");
      sign("=");
      out.number = count(15);
    } else {
      sign("(");
      sign(")");
    }
    return out;
  }

  void trans(Statement& out) {
    out.literal = true;
    word("trans");
    sign("(");
    for (std::size_t i = 0; i < 6; ++i) {
      if (i > 0) sign(",");
      out.trans[i] = number();
    }
    sign(")");
  }

  Statement assignment() {
    Statement out = started(StatementKind::kSet);
    take();
    out.name = name();
    sign("=");
    if (is_word("trans")) {
      trans(out);
      return out;
    }
    word("frame");
    sign("(");
    for (std::size_t i = 0; i < 4; ++i) {
      if (i > 0) sign(",");
      out.points[i] = name();
    }
    sign(")");
    return out;
  }

  Statement speed() {
    Statement out = started(StatementKind::kSpeed);
    take();
    out.speed_mm_s = number();
    if (!(out.speed_mm_s > 0.0)) refuse(source_, out.line, "a speed that is not above 0", "mm/s");
    if (skip_sign(",")) {
      out.turn_percent = number();
      if (!(out.turn_percent > 0.0 && out.turn_percent <= 100.0))
        refuse(source_, out.line, "a turning speed outside (0, 100]", "percent of the robot's full speed");
    }
    word("mmps");
    word("always");
    return out;
  }

  Statement signal() {
    Statement out = started(StatementKind::kSignal);
    take();
    out.on = !skip_sign("-");
    out.number = count(9999);
    return out;
  }

  void signal_state(Statement& out) {
    word("sig");
    sign("(");
    out.on = !skip_sign("-");
    out.number = count(9999);
    sign(")");
  }

  Statement timer() {
    Statement out = started(StatementKind::kTimer);
    take();
    out.timer = count(15);
    sign("=");
    if (number() != 0.0) refuse(source_, out.line, "a timer that does not start at 0", "0");
    return out;
  }

  Statement wait() {
    Statement out = started(StatementKind::kWait);
    take();
    signal_state(out);
    if (!skip_word("or")) return out;
    const bool bracket = skip_sign("(");
    word("timer");
    sign("(");
    out.timer = count(15);
    sign(")");
    sign(">");
    out.timeout_s = number();
    if (!(out.timeout_s > 0.0)) refuse(source_, out.line, "a wait of no time", "a time above 0");
    if (bracket) sign(")");
    return out;
  }

  Statement conditional() {
    Statement out = started(StatementKind::kIf);
    take();
    word("not");
    signal_state(out);
    word("then");
    end_of_line();
    if (++depth_ > 4) wrong("fewer IF within IF");
    out.body = statements();
    --depth_;
    word("end");
    return out;
  }

  Statement move() {
    Statement out = started(StatementKind::kMove);
    const bool appro = is_word("appro") || is_word("appros");
    out.joint = is_word("move") || is_word("appro");
    take();
    location(out);
    if (appro) {
      sign(",");
      out.away_mm = number();
    }
    return out;
  }

  void location(Statement& out) {
    if (is_word("trans")) return trans(out);
    out.point = name();
    if (!skip_sign(":")) return;
    out.name = std::move(out.point);
    out.point = {};
    if (is_word("trans")) return trans(out);
    out.point = name();
  }

  Statement depart() {
    Statement out = started(StatementKind::kDepart);
    out.joint = is_word("depart");
    take();
    out.away_mm = number();
    return out;
  }

  File file_;
  int depth_ = 0;
};

}  // namespace

File parse_vplus(std::string_view text, const std::string& file) {
  return Parser(text, file).run();
}

}  // namespace arris::vplus_reader
