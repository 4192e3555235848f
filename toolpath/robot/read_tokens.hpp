#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "toolpath/robot/reading.hpp"

namespace arris::program_reader {

/// What a text of a robot language is made of; names and words know no case in any of them.
struct Language {
  const char* name;                     ///< as errors call it
  char comment;                         ///< from here to the end of the line
  std::vector<std::string_view> signs;  ///< longer ones before their beginnings
  std::string_view in_names;            ///< beside letters and digits
  std::string_view before_names = "";   ///< may begin a name, ".PROGRAM"
  std::size_t longest_name = 32;        ///< characters
  std::size_t longest_line = 0;         ///< characters; 0: any
  bool by_lines = false;                ///< the end of a line ends a statement
  std::string_view unused_number = "";  ///< a number that means "no value"
};

enum class TokenKind { kName, kNumber, kUnused, kText, kSign, kLine, kEnd };

/// One token of a program. kLine is the end of a line, in languages that go by lines.
struct Token {
  TokenKind kind = TokenKind::kEnd;
  std::string text;     ///< names in lower case, texts without quotes, signs as they stand
  std::string written;  ///< names as they stand
  double number = 0.0;
  int line = 0;
};

struct Comment {
  std::string text;       ///< without its sign and the blanks round it
  std::size_t begin = 0;  ///< where `text` begins in the program
};

struct Tokens {
  std::vector<Token> all;  ///< ends with kEnd
  std::vector<Comment> comments;
};

/// A name that must be looked up: in lower case, and as it stands.
struct Name {
  std::string key, written;
};

/// The text that is read, for messages.
struct Source {
  std::string file;
  const char* language;
};

/// Throws Error(kInput) with the line for a character, name, number or line that the language does not have.
[[nodiscard]] Tokens tokens_of(std::string_view text, const Language& language, const std::string& file);

/// Error(kInput): "not a .. program as expected (file, line n): found ..; needed ..".
[[noreturn]] void refuse(const Source& source, int line, const std::string& found, const std::string& needed);

/// Fills comments, result_hash, body_sha256 and hashed_text from the comments of a program; throws
/// Error(kInput) when one of the hashes is stated twice.
void read_head(std::string_view text, const std::vector<Comment>& comments, const Source& source,
               Reading& into);

/// Walks the tokens; what every grammar asks of them. Each word_, sign_, number_ throws Error(kInput) when
/// something else stands there.
class Cursor {
 protected:
  Cursor(Tokens tokens, Source source) : tokens_(std::move(tokens)), source_(std::move(source)) {}

  [[nodiscard]] const Token& here(std::size_t ahead = 0) const;
  const Token& take() { return tokens_.all[at_++]; }
  [[noreturn]] void wrong(const std::string& needed) const;
  [[nodiscard]] bool is_word(const char* text) const;
  [[nodiscard]] bool is_sign(const char* text) const;
  void word(const char* text);
  void sign(const char* text);
  /// Steps over the sign when it stands here.
  bool skip_sign(const char* text);
  bool skip_word(const char* text);
  /// With its sign; a zero has none.
  double number();

  Tokens tokens_;
  Source source_;

 private:
  std::size_t at_ = 0;
};

}  // namespace arris::program_reader
