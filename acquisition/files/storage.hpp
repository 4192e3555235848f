#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "acquisition/types/error.hpp"

namespace arris::files {

/// Error(kInput) for a failed call on the file system; `code` is its errno, put into words with a next step.
[[nodiscard]] Error storage_error(const std::string& what, const std::filesystem::path& where, int code);

/// The path without "." and ".." and without a slash at its end.
[[nodiscard]] std::filesystem::path plain_path(const std::filesystem::path& path);

/// The folder a path lies in; "." for a bare name.
[[nodiscard]] std::filesystem::path folder_of(const std::filesystem::path& path);

/// Tries hidden names beside the target until make(name) is true or fails for another reason than that the
/// name is taken; returns the last one tried. errno is that of the last make().
[[nodiscard]] std::string make_temporary(const std::filesystem::path& target,
                                         const std::function<bool(const std::string&)>& make);

/// fsync of a file or folder; throws Error(kInput).
void flush_to_disk(const std::filesystem::path& path);

}  // namespace arris::files
