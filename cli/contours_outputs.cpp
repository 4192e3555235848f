#include "cli/contours_outputs.hpp"

#include <array>
#include <fstream>
#include <string_view>

#include "acquisition/types/error.hpp"
#include "cli/contours_file.hpp"

namespace arris {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";

/// The same file, by whatever name; also of names of which nothing exists yet.
bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  return fs::weakly_canonical(fs::absolute(a), error) == fs::weakly_canonical(fs::absolute(b), error);
}

bool is_png(const fs::path& file) {
  std::array<char, kPngSignature.size()> begin{};
  std::ifstream(file, std::ios::binary).read(begin.data(), begin.size());
  return std::string_view(begin.data(), begin.size()) == kPngSignature;
}

/// Why a file is no choice of ours; empty when it is one.
std::string why_no_choice(const fs::path& file) {
  try {
    (void)read_contour_choice(file);
    return {};
  } catch (const Error& error) {
    return error.text().found.empty() ? error.text().what : error.text().found;
  }
}

[[noreturn]] void refuse(const std::string& option, const fs::path& file, const std::string& found,
                         const std::string& needed) {
  throw Error(Fault::kInput, {.what = option + " would overwrite a file that is not its own",
                              .where = file.string(),
                              .found = found,
                              .needed = needed,
                              .next = "choose another name, or remove the file"});
}

void check_inputs(const std::string& option, const fs::path& file, const ContoursArgs& args,
                  const Recipe& recipe) {
  const std::string needed = "a name of its own";
  if (same_file(file, args.file)) refuse(option, file, "the file whose contours are asked for", needed);
  if (args.recipe && same_file(file, *args.recipe)) refuse(option, file, "the recipe", needed);
  if (args.recipe && same_file(file, recipe.part.cad)) refuse(option, file, "the recipe's drawing", needed);
}

}  // namespace

void check_contours_outputs(const ContoursArgs& args, const Recipe& recipe) {
  if (args.out) {
    check_inputs("--out", *args.out, args, recipe);
    const bool exists = fs::exists(fs::symlink_status(*args.out));
    if (const std::string why = exists ? why_no_choice(*args.out) : std::string(); !why.empty())
      refuse("--out", *args.out, "no contour choice of arris: " + why, "a new name, or a former choice");
  }
  if (!args.png) return;
  check_inputs("--png", *args.png, args, recipe);
  if (args.out && same_file(*args.out, *args.png))
    refuse("--png", *args.png, "the file of --out", "a name of its own");
  if (fs::exists(fs::symlink_status(*args.png)) && !is_png(*args.png))
    refuse("--png", *args.png, "a file that is no PNG", "a new name, or a former picture");
}

}  // namespace arris
