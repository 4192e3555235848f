#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "acquisition/types/error.hpp"

namespace arris {

/// Where the value of a key goes. The field holds the default until a file sets it; empty means unset.
using Slot = std::variant<std::string*, std::filesystem::path*, bool*, int*, double*, std::optional<double>*,
                          std::vector<int>*, std::vector<double>*, std::vector<std::string>*>;

/// One key of a TOML file: what reading, printing, the docs and the tests know of it. Unit ends the name.
struct Key {
  std::string name;  ///< dotted: "registration.subdivision.band_mm"
  Slot slot;
  std::string about;                    ///< one line for people
  bool required = false;                ///< marked * in what is printed
  std::vector<std::string> words = {};  ///< the allowed texts; empty: any
  std::vector<std::string> later = {};  ///< texts of the format that this version cannot do yet
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::vector<std::size_t> lengths = {};  ///< how many entries a list may have; empty: any
  std::string example = {};               ///< of a key that may stay unset; printed behind a #
};

/// A file that was read against a table.
struct KeysRead {
  std::set<std::string> given;      ///< names of the keys that the file sets
  std::set<std::string> tables;     ///< tables that the file opens, empty ones included
  std::vector<ErrorText> problems;  ///< in the order of the file; empty: the file is good
};

/// Reads TOML text against a table: unknown keys, wrong types, ranges, words, missing keys, each as one
/// problem with its line. A relative path becomes relative to the folder of `file`. Values with a problem
/// stay at their default. Tables named in `reserved` are let pass unread.
[[nodiscard]] KeysRead read_keys(const std::filesystem::path& file, const std::string& text,
                                 const std::vector<Key>& keys, const std::set<std::string>& reserved = {});

/// Checks a value in its slot: range, words, words of a later version, lengths. Nothing: good. Without where.
[[nodiscard]] std::optional<ErrorText> check_value(const Key& key);

/// The value in the slot as TOML; "" when unset.
[[nodiscard]] std::string value_text(const Key& key, const std::filesystem::path& folder = {});

/// "a number", "one of clamped, free", "3 numbers": what the key takes, for messages and docs.
[[nodiscard]] std::string type_text(const Key& key);

/// The whole table as a TOML file with a comment a key; keys without a value are commented out.
///   folder   paths are printed relative to it
///   absent   tables whose presence means something and that are not there: commented out as a whole
[[nodiscard]] std::string print_keys(const std::vector<Key>& keys, const std::filesystem::path& folder = {},
                                     const std::set<std::string>& absent = {});

/// The name nearest to `wrong` by edit distance (insert, delete, replace, swap); empty when none is near.
[[nodiscard]] std::string nearest_name(std::string_view wrong, const std::vector<std::string>& names);

/// `text` in quotes, escaped as TOML and JSON both read it.
[[nodiscard]] std::string quote(std::string_view text);

}  // namespace arris
