#include "toolpath/robot/read_tokens.hpp"

#include <algorithm>
#include <cctype>

#include "acquisition/types/error.hpp"

namespace arris::program_reader {
namespace {

class Tokeniser {
 public:
  Tokeniser(std::string_view text, const Language& language, const std::string& file)
      : text_(text), language_(language), source_{file, language.name} {}

  Tokens run() {
    check_lines();
    while (at_ < text_.size()) take();
    push(TokenKind::kEnd, "");
    return std::move(out_);
  }

 private:
  [[nodiscard]] char ahead(std::size_t by = 0) const {
    return at_ + by < text_.size() ? text_[at_ + by] : '\0';
  }
  static bool digit(char c) { return c >= '0' && c <= '9'; }
  static bool within(std::string_view set, char c) { return set.find(c) != std::string_view::npos; }
  static bool letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

  Token& push(TokenKind kind, std::string text) {
    Token token;
    token.kind = kind;
    token.text = std::move(text);
    token.line = line_;
    out_.all.push_back(std::move(token));
    return out_.all.back();
  }

  void check_lines() const {
    if (language_.longest_line == 0) return;
    int line = 1;
    for (std::size_t begin = 0; begin < text_.size(); ++line) {
      const std::size_t end = std::min(text_.find('\n', begin), text_.size());
      if (end - begin > language_.longest_line + 1)  // one more for a carriage return
        refuse(source_, line, "a line of " + std::to_string(end - begin) + " characters",
               "at most " + std::to_string(language_.longest_line));
      begin = end + 1;
    }
  }

  void take() {
    const char c = ahead();
    if (c == '\n') {
      if (language_.by_lines) push(TokenKind::kLine, "");
      ++line_;
      ++at_;
    } else if (c == ' ' || c == '\t' || (c == '\r' && ahead(1) == '\n')) {
      ++at_;
    } else if (c == language_.comment) {
      comment();
    } else if (letter(c) || (within(language_.before_names, c) && letter(ahead(1)))) {
      name();
    } else if (digit(c)) {
      number();
    } else if (c == '"') {
      quoted();
    } else {
      sign();
    }
  }

  void sign() {
    for (const std::string_view sign : language_.signs) {
      if (text_.substr(at_, sign.size()) != sign) continue;
      push(TokenKind::kSign, std::string(sign));
      at_ += sign.size();
      return;
    }
    refuse(source_, line_,
           "character " + std::to_string(static_cast<int>(static_cast<unsigned char>(ahead()))),
           std::string("ASCII letters, digits and the signs of ") + language_.name);
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
    const std::size_t begin = at_++;
    while (letter(ahead()) || digit(ahead()) || (at_ < text_.size() && within(language_.in_names, ahead())))
      ++at_;
    const std::string written(text_.substr(begin, at_ - begin));
    if (written.size() > language_.longest_name)
      refuse(source_, line_, "the name " + written,
             "at most " + std::to_string(language_.longest_name) + " characters");
    std::string lower = written;
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    push(TokenKind::kName, lower).written = written;
  }

  void number() {
    const std::size_t begin = at_;
    const std::string_view unused = language_.unused_number;
    const char behind = ahead(unused.size());
    if (!unused.empty() && text_.substr(at_, unused.size()) == unused && !digit(behind) && !letter(behind) &&
        behind != '.') {
      push(TokenKind::kUnused, std::string(unused));
      at_ += unused.size();
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
      refuse(source_, line_,
             "'" + std::string(text_.substr(begin, at_ - begin + (ahead() > ' ' ? 1 : 0))) + "'",
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
  const Language& language_;
  Source source_;
  Tokens out_;
  std::size_t at_ = 0;
  int line_ = 1;
};

}  // namespace

Tokens tokens_of(std::string_view text, const Language& language, const std::string& file) {
  return Tokeniser(text, language, file).run();
}

void refuse(const Source& source, int line, const std::string& found, const std::string& needed) {
  throw Error(Fault::kInput, ErrorText{std::string("not a ") + source.language + " program as expected",
                                       source.file + ", line " + std::to_string(line), found, needed, ""});
}

void read_head(std::string_view text, const std::vector<Comment>& comments, const Source& source,
               Reading& into) {
  const auto stated = [&](const std::string& comment, const std::string& key, std::string& value) {
    if (comment.compare(0, key.size(), key) != 0) return false;
    if (!value.empty()) refuse(source, 1, "two lines of " + key, "one");
    value = comment.substr(key.size());
    return true;
  };
  into.hashed_text = std::string(text);
  for (const Comment& comment : comments) {
    into.comments.push_back(comment.text);
    stated(comment.text, "result_hash = ", into.result_hash);
    if (stated(comment.text, "body_sha256 = ", into.body_sha256))
      into.hashed_text.erase(comment.begin + comment.text.size() - into.body_sha256.size(),
                             into.body_sha256.size());
  }
}

const Token& Cursor::here(std::size_t ahead) const {
  return tokens_.all[std::min(at_ + ahead, tokens_.all.size() - 1)];
}

void Cursor::wrong(const std::string& needed) const {
  const Token& token = here();
  const auto as_found = [&]() -> std::string {
    if (token.kind == TokenKind::kEnd) return "the end of the text";
    if (token.kind == TokenKind::kLine) return "the end of the line";
    return "'" + (token.written.empty() ? token.text : token.written) + "'";
  };
  refuse(source_, token.line, as_found(), needed);
}

bool Cursor::is_word(const char* text) const {
  return here().kind == TokenKind::kName && here().text == text;
}

bool Cursor::is_sign(const char* text) const {
  return here().kind == TokenKind::kSign && here().text == text;
}

void Cursor::word(const char* text) {
  if (!skip_word(text)) wrong("the word " + std::string(text));
}

void Cursor::sign(const char* text) {
  if (!skip_sign(text)) wrong("'" + std::string(text) + "'");
}

bool Cursor::skip_word(const char* text) {
  const bool there = is_word(text);
  if (there) ++at_;
  return there;
}

bool Cursor::skip_sign(const char* text) {
  const bool there = is_sign(text);
  if (there) ++at_;
  return there;
}

double Cursor::number() {
  const bool minus = skip_sign("-");
  if (here().kind != TokenKind::kNumber) wrong("a number");
  const double value = here().number;
  if (minus && value == 0.0) wrong("a zero without sign");
  ++at_;
  return minus ? -value : value;
}

}  // namespace arris::program_reader
