#include "toolpath/robot/read_rapid_grammar.hpp"

#include <set>

namespace arris::rapid_reader {
namespace {

const std::set<std::string> kWords = {"module",   "endmodule", "proc",  "endproc",   "error",     "if",
                                      "then",     "endif",     "const", "pers",      "var",       "exit",
                                      "raise",    "return",    "true",  "false",     "movej",     "movel",
                                      "setdo",    "waitdi",    "confj", "confl",     "tpwrite",   "tooldata",
                                      "wobjdata", "bool",      "offs",  "speeddata", "robtarget", "zonedata"};
const std::set<std::string> kTypes = {"tooldata", "wobjdata", "speeddata", "zonedata", "robtarget", "bool"};

class Parser {
 public:
  Parser(std::string_view text, const std::string& source)
      : tokens_(tokens_of(text, source)), source_(source) {}

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
  [[nodiscard]] const Token& here() const { return tokens_.all[at_]; }
  [[noreturn]] void wrong(const std::string& needed) const {
    const Token& token = here();
    const bool end = token.kind == TokenKind::kEnd;
    refuse(source_, token.line,
           end ? "the end of the text" : "'" + (token.written.empty() ? token.text : token.written) + "'",
           needed);
  }
  [[nodiscard]] bool is_word(const char* text) const {
    return here().kind == TokenKind::kName && here().text == text;
  }
  [[nodiscard]] bool is_sign(const char* text) const {
    return here().kind == TokenKind::kSign && here().text == text;
  }
  void word(const char* text) {
    if (!is_word(text)) wrong("the word " + std::string(text));
    ++at_;
  }
  void sign(const char* text) {
    if (!is_sign(text)) wrong("'" + std::string(text) + "'");
    ++at_;
  }
  Name name() {
    if (here().kind != TokenKind::kName || kWords.count(here().text) > 0) wrong("a name");
    const Token& token = tokens_.all[at_++];
    return {token.text, token.written};
  }
  double number() {
    const bool minus = is_sign("-");
    if (minus) ++at_;
    if (here().kind != TokenKind::kNumber) wrong("a number");
    const double value = here().number;
    if (minus && value == 0.0) wrong("a zero without sign");
    ++at_;
    return minus ? -value : value;
  }
  int bit() {
    if (here().kind != TokenKind::kNumber || (here().text != "0" && here().text != "1")) wrong("0 or 1");
    return tokens_.all[at_++].text == "1" ? 1 : 0;
  }

  Value value() {
    Value out;
    out.line = here().line;
    if (is_sign("[")) {
      out.kind = ValueKind::kList;
      do {
        ++at_;
        if (depth_ > 8) wrong("fewer brackets");
        ++depth_;
        out.items.push_back(value());
        --depth_;
      } while (is_sign(","));
      sign("]");
    } else if (here().kind == TokenKind::kText) {
      out.kind = ValueKind::kText;
      ++at_;
    } else if (here().kind == TokenKind::kUnused) {
      out.kind = ValueKind::kUnused;
      ++at_;
    } else if (is_word("true") || is_word("false")) {
      out.kind = ValueKind::kTruth;
      out.truth = is_word("true");
      ++at_;
    } else {
      out.number = number();
    }
    return out;
  }

  void declaration() {
    Declaration found;
    found.line = here().line;
    found.storage = tokens_.all[at_++].text;
    if (here().kind != TokenKind::kName || kTypes.count(here().text) == 0) wrong("a data type");
    found.type = tokens_.all[at_++].text;
    const Name declared = name();
    found.written = declared.written;
    if (is_sign(":=")) {
      ++at_;
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
      ++at_;
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
      ++at_;
      out.kind = StatementKind::kSet;
      out.signal = name();
      sign(",");
      out.value = bit();
    } else if (is_word("waitdi")) {
      wait(out);
    } else if (is_word("tpwrite")) {
      ++at_;
      out.kind = StatementKind::kPrint;
      if (here().kind != TokenKind::kText) wrong("a string");
      if (here().text.size() > 80) wrong("a string of at most 80 characters");
      ++at_;
    } else if (is_word("exit") || is_word("raise")) {
      out.kind = is_word("exit") ? StatementKind::kExit : StatementKind::kRaise;
      ++at_;
    } else {
      out.kind = StatementKind::kCall;
      out.signal = name();
    }
    sign(";");
    return out;
  }

  void conditional(Statement& out) {
    ++at_;
    out.kind = StatementKind::kIf;
    out.signal = name();
    word("then");
    out.body = statements();
    word("endif");
  }

  void conf(Statement& out) {
    out.kind = StatementKind::kConf;
    out.joint = is_word("confj");
    ++at_;
    sign("\\");
    out.on = is_word("on");
    if (!out.on && !is_word("off")) wrong("On or Off");
    ++at_;
  }

  void wait(Statement& out) {
    ++at_;
    out.kind = StatementKind::kWait;
    out.signal = name();
    sign(",");
    out.value = bit();
    if (is_sign("\\") && tokens_.all[at_ + 1].text == "maxtime") {
      at_ += 2;
      sign(":=");
      out.timeout_s = number();
      if (!(out.timeout_s > 0.0)) wrong("a time above 0 before this");
    }
    if (is_sign("\\")) {
      ++at_;
      word("timeflag");
      sign(":=");
      out.flag = name();
    }
  }

  void move(Statement& out) {
    out.kind = StatementKind::kMove;
    out.joint = is_word("movej");
    ++at_;
    if (is_sign("[")) {
      out.literal = value();
    } else if (is_word("offs")) {
      ++at_;
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
      ++at_;
      word("wobj");
      sign(":=");
      out.work = name();
    }
  }

  Tokens tokens_;
  std::string source_;
  Module module_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

Module parse_rapid(std::string_view text, const std::string& source) {
  return Parser(text, source).run();
}

}  // namespace arris::rapid_reader
