#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace arris::rapid_reader {

enum class TokenKind { kName, kNumber, kUnused, kText, kSign, kEnd };

/// One token of a RAPID text. kUnused is 9E9, the controller's "no value".
struct Token {
  TokenKind kind = TokenKind::kEnd;
  std::string text;     ///< names in lower case, texts without quotes, signs as they stand (":=" is one)
  std::string written;  ///< names as they stand
  double number = 0.0;
  int line = 0;
};

struct Comment {
  std::string text;       ///< without the `!` and the blanks round it
  std::size_t begin = 0;  ///< where `text` begins in the program
};

struct Tokens {
  std::vector<Token> all;  ///< ends with kEnd
  std::vector<Comment> comments;
};

/// Throws Error(kInput) with the line for a character or a number that RAPID, as read here, does not have.
[[nodiscard]] Tokens tokens_of(std::string_view text, const std::string& source);

/// Error(kInput): "not a RAPID program as expected (source, line n): found ..; needed ..".
[[noreturn]] void refuse(const std::string& source, int line, const std::string& found,
                         const std::string& needed);

}  // namespace arris::rapid_reader
