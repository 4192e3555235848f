#include "toolpath/robot/read_rapid_grammar.hpp"

#include <set>

namespace arris::rapid_reader {
namespace {

using namespace program_reader;  // NOLINT: tokens and cursor

const std::set<std::string> kWords = {"module",   "endmodule", "proc",  "endproc",   "error",     "if",
                                      "then",     "endif",     "const", "pers",      "var",       "exit",
                                      "raise",    "return",    "true",  "false",     "movej",     "movel",
                                      "setdo",    "waitdi",    "confj", "confl",     "tpwrite",   "tooldata",
                                      "wobjdata", "bool",      "offs",  "speeddata", "robtarget", "zonedata"};
const std::set<std::string> kTypes = {"tooldata", "wobjdata", "speeddata", "zonedata", "robtarget", "bool"};

const Language kRapid = {.name = "RAPID",
                         .comment = '!',
                         .signs = {":=", "[", "]", "(", ")", ",", ";", "\\", "-"},
                         .in_names = "_",
                         .unused_number = "9E9"};

class Parser : private Cursor {
 public:
  Parser(std::string_view text, const std::string& file)
      : Cursor(tokens_of(text, kRapid, file), {file, kRapid.name}) {}

  Module run() {
    word("module");
    module_.name = name().written;
    while (is_word("const") || is_word("pers") || is_word("var")) declaration();
    while (is_word("proc")) procedure();
    word("endmodule");
    if (here().kind != TokenKind::kEnd) wrong("the end of the text behind ENDMODULE");
    module_.comments = std::move(tokens_.comments);
    return std::move(module_);
  }

 private:
  Name name() {
    if (here().kind != TokenKind::kName || kWords.count(here().text) > 0) wrong("a name");
    const Token& token = take();
    return {token.text, token.written};
  }
  int bit() {
    if (here().kind != TokenKind::kNumber || (here().text != "0" && here().text != "1")) wrong("0 or 1");
    return take().text == "1" ? 1 : 0;
  }

  Value value() {
    Value out;
    out.line = here().line;
    if (is_sign("[")) {
      out.kind = ValueKind::kList;
      do {
        take();
        if (depth_ > 8) wrong("fewer brackets");
        ++depth_;
        out.items.push_back(value());
        --depth_;
      } while (is_sign(","));
      sign("]");
    } else if (here().kind == TokenKind::kText) {
      out.kind = ValueKind::kText;
      take();
    } else if (here().kind == TokenKind::kUnused) {
      out.kind = ValueKind::kUnused;
      take();
    } else if (is_word("true") || is_word("false")) {
      out.kind = ValueKind::kTruth;
      out.truth = is_word("true");
      take();
    } else {
      out.number = number();
    }
    return out;
  }

  void declaration() {
    Declaration found;
    found.line = here().line;
    found.storage = take().text;
    if (here().kind != TokenKind::kName || kTypes.count(here().text) == 0) wrong("a data type");
    found.type = take().text;
    const Name declared = name();
    found.written = declared.written;
    if (is_sign(":=")) {
      take();
      found.value = value();
      found.has_value = true;
    }
    sign(";");
    unused(declared, found.line);
    module_.data.emplace(declared.key, std::move(found));
  }

  void unused(const Name& declared, int line) const {
    if (module_.data.count(declared.key) + module_.procedures.count(declared.key) > 0)
      refuse(source_, line, "a second " + declared.written, "each name once");
  }

  void procedure() {
    Procedure found;
    found.line = here().line;
    word("proc");
    const Name declared = name();
    unused(declared, found.line);
    sign("(");
    sign(")");
    found.body = statements();
    if (is_word("error")) {
      take();
      found.on_error = statements();
      if (found.on_error.empty()) wrong("what to do on an error");
    }
    word("endproc");
    module_.procedures.emplace(declared.key, std::move(found));
  }

  std::vector<Statement> statements() {
    std::vector<Statement> all;
    while (!is_word("error") && !is_word("endproc") && !is_word("endif") && here().kind != TokenKind::kEnd)
      all.push_back(statement());
    return all;
  }

  Statement statement() {
    Statement out;
    out.line = here().line;
    if (is_word("if")) {
      conditional(out);
      return out;
    }
    if (is_word("movej") || is_word("movel")) {
      move(out);
    } else if (is_word("confj") || is_word("confl")) {
      conf(out);
    } else if (is_word("setdo")) {
      take();
      out.kind = StatementKind::kSet;
      out.signal = name();
      sign(",");
      out.value = bit();
    } else if (is_word("waitdi")) {
      wait(out);
    } else if (is_word("tpwrite")) {
      take();
      out.kind = StatementKind::kPrint;
      if (here().kind != TokenKind::kText) wrong("a string");
      if (here().text.size() > 80) wrong("a string of at most 80 characters");
      take();
    } else if (is_word("exit") || is_word("raise")) {
      out.kind = is_word("exit") ? StatementKind::kExit : StatementKind::kRaise;
      take();
    } else {
      out.kind = StatementKind::kCall;
      out.signal = name();
    }
    sign(";");
    return out;
  }

  void conditional(Statement& out) {
    take();
    out.kind = StatementKind::kIf;
    out.signal = name();
    word("then");
    out.body = statements();
    word("endif");
  }

  void conf(Statement& out) {
    out.kind = StatementKind::kConf;
    out.joint = is_word("confj");
    take();
    sign("\\");
    out.on = is_word("on");
    if (!out.on && !is_word("off")) wrong("On or Off");
    take();
  }

  void wait(Statement& out) {
    take();
    out.kind = StatementKind::kWait;
    out.signal = name();
    sign(",");
    out.value = bit();
    if (is_sign("\\") && here(1).text == "maxtime") {
      take();
      take();
      sign(":=");
      out.timeout_s = number();
      if (!(out.timeout_s > 0.0)) wrong("a time above 0 before this");
    }
    if (is_sign("\\")) {
      take();
      word("timeflag");
      sign(":=");
      out.flag = name();
    }
  }

  void move(Statement& out) {
    out.kind = StatementKind::kMove;
    out.joint = is_word("movej");
    take();
    if (is_sign("[")) {
      out.literal = value();
    } else if (is_word("offs")) {
      take();
      sign("(");
      out.target = name();
      for (double& part_mm : out.offset_mm) {
        sign(",");
        part_mm = number();
      }
      sign(")");
    } else {
      out.target = name();
    }
    sign(",");
    out.speed = name();
    sign(",");
    out.zone = name();
    sign(",");
    out.tool = name();
    if (is_sign("\\")) {
      take();
      word("wobj");
      sign(":=");
      out.work = name();
    }
  }

  Module module_;
  int depth_ = 0;
};

}  // namespace

Module parse_rapid(std::string_view text, const std::string& file) {
  return Parser(text, file).run();
}

}  // namespace arris::rapid_reader
