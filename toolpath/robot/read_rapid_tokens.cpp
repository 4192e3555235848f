#include "toolpath/robot/read_rapid_tokens.hpp"

#include <cctype>

#include "acquisition/types/error.hpp"

namespace arris::rapid_reader {
namespace {

class Tokeniser {
 public:
  Tokeniser(std::string_view text, const std::string& source) : text_(text), source_(source) {}

  Tokens run() {
    while (at_ < text_.size()) take();
    Token end;
    end.line = line_;
    out_.all.push_back(end);
    return std::move(out_);
  }

 private:
  [[nodiscard]] char ahead(std::size_t by = 0) const {
    return at_ + by < text_.size() ? text_[at_ + by] : '\0';
  }
  static bool digit(char c) { return c >= '0' && c <= '9'; }
  static bool letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

  Token& push(TokenKind kind, std::string text) {
    Token token;
    token.kind = kind;
    token.text = std::move(text);
    token.line = line_;
    out_.all.push_back(std::move(token));
    return out_.all.back();
  }

  void take() {
    const char c = ahead();
    if (c == '\n') {
      ++line_;
      ++at_;
    } else if (c == ' ' || c == '\t' || (c == '\r' && ahead(1) == '\n')) {
      ++at_;
    } else if (c == '!') {
      comment();
    } else if (letter(c)) {
      name();
    } else if (digit(c)) {
      number();
    } else if (c == '"') {
      quoted();
    } else if (c == ':' && ahead(1) == '=') {
      push(TokenKind::kSign, ":=");
      at_ += 2;
    } else if (std::string_view("[](),;\\-").find(c) != std::string_view::npos) {
      push(TokenKind::kSign, std::string(1, c));
      ++at_;
    } else {
      refuse(source_, line_, "character " + std::to_string(static_cast<int>(static_cast<unsigned char>(c))),
             "ASCII letters, digits and the signs of RAPID");
    }
  }

  void comment() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    for (std::size_t i = at_; i < end; ++i)
      if (static_cast<unsigned char>(text_[i]) > 126)
        refuse(source_, line_, "a character beyond ASCII", "ASCII alone");
    std::string_view body = text_.substr(at_ + 1, end - at_ - 1);
    while (!body.empty() && (body.front() == ' ' || body.front() == '\t')) body.remove_prefix(1);
    while (!body.empty() && (body.back() == ' ' || body.back() == '\r')) body.remove_suffix(1);
    Comment found;
    found.text = std::string(body);
    found.begin = static_cast<std::size_t>(body.data() - text_.data());
    out_.comments.push_back(std::move(found));
    at_ = end;
  }

  void name() {
    const std::size_t begin = at_;
    while (letter(ahead()) || digit(ahead()) || ahead() == '_') ++at_;
    const std::string written(text_.substr(begin, at_ - begin));
    if (written.size() > 32) refuse(source_, line_, "the name " + written, "at most 32 characters");
    std::string lower = written;
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    push(TokenKind::kName, lower).written = written;
  }

  void number() {
    const std::size_t begin = at_;
    if (text_.substr(at_, 3) == "9E9" && !digit(ahead(3)) && !letter(ahead(3)) && ahead(3) != '.') {
      push(TokenKind::kUnused, "9E9");
      at_ += 3;
      return;
    }
    double value = 0.0, unit = 1.0;
    while (digit(ahead())) value = value * 10.0 + (text_[at_++] - '0');
    if (ahead() == '.') {
      ++at_;
      if (!digit(ahead())) refuse(source_, line_, "a number that ends in a point", "digits behind the point");
      while (digit(ahead())) {
        value = value * 10.0 + (text_[at_++] - '0');
        unit *= 10.0;
      }
    }
    if (letter(ahead()) || ahead() == '.' || ahead() == '_' || at_ - begin > 24)
      refuse(source_, line_, "'" + std::string(text_.substr(begin, at_ - begin + 1)) + "'",
             "a number without exponent");
    push(TokenKind::kNumber, std::string(text_.substr(begin, at_ - begin))).number = value / unit;
  }

  void quoted() {
    const std::size_t begin = ++at_;
    while (ahead() != '"') {
      if (at_ >= text_.size() || ahead() == '\n')
        refuse(source_, line_, "a string without end", "a closing quote");
      if (ahead() < ' ' || ahead() > '~') refuse(source_, line_, "a character beyond ASCII", "ASCII alone");
      ++at_;
    }
    push(TokenKind::kText, std::string(text_.substr(begin, at_ - begin)));
    ++at_;
  }

  std::string_view text_;
  std::string source_;
  Tokens out_;
  std::size_t at_ = 0;
  int line_ = 1;
};

}  // namespace

Tokens tokens_of(std::string_view text, const std::string& source) {
  return Tokeniser(text, source).run();
}

void refuse(const std::string& source, int line, const std::string& found, const std::string& needed) {
  throw Error(Fault::kInput, ErrorText{"not a RAPID program as expected",
                                       source + ", line " + std::to_string(line), found, needed, ""});
}

}  // namespace arris::rapid_reader
