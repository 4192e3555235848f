// The paper's experiments with our parts: tables and figures. Prints Markdown; with --out it replaces the
// part of that page between its markers (not with --part or --quick), with --figures it writes the redrawn
// figures there.

#include <iostream>
#include <iterator>
#include <map>

#include "tests/bench/paper/experiments.hpp"
#include "tests/bench/paper/figures.hpp"
#include "tests/support/bench_program.hpp"

namespace {

using namespace arris::bench;  // NOLINT: one small program

const char kUsage[] =
    "bench_paper [--fixtures fixtures/fe] [--seeds 5] [--threads 2] [--part NAME] [--quick] [--out FILE.md] "
    "[--figures FOLDER]\n";

struct Arguments {
  std::filesystem::path fixtures, out, figures;
  int seeds = 0, threads = 0;
  std::string part;    ///< only what uses it
  bool quick = false;  ///< one seed, no spacing below 2 mm
  /// Less than that is a look, and leaves the page as it is.
  [[nodiscard]] bool is_whole() const { return part.empty() && !quick; }
};

Arguments parse(int argc, char** argv) {
  const Words words(argc, argv, kUsage,
                    {"--fixtures", "--out", "--figures", "--part", "--seeds", "--threads"}, {"--quick"});
  Arguments arguments;
  arguments.fixtures = words.text("--fixtures", "fixtures/fe");
  arguments.out = words.text("--out");
  arguments.figures = words.text("--figures");
  arguments.part = words.text("--part");
  arguments.quick = words.has("--quick");
  arguments.seeds = words.count("--seeds", arguments.quick ? 1 : 5, 1);
  arguments.threads = words.count("--threads", 2, 0);
  return arguments;
}

/// What goes between the page's markers, by the name of the section, and the figures.
struct Made {
  std::map<std::string, std::string> sections;
  std::vector<Figure> figures;
  void add(std::vector<Figure> more) {
    figures.insert(figures.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  }
};

void say(const std::string& part, const char* what) {
  std::cerr << part << ": " << what << std::endl;
}

void run_part(const std::string& name, const Arguments& arguments, Made& made) {
  const BenchPart part(arguments.fixtures / name, arguments.threads);
  const int seeds = arguments.seeds;
  if (name == "porthole") {
    say(name, "methods side by side");
    made.sections["porthole"] = porthole_section(part, seeds);
    made.add(porthole_figures(part));
    say(name, "spacing");
    made.sections["density"] = density_section(part, seeds, arguments.quick);
  }
  if (name == "nosecone") {
    say(name, "methods side by side");
    made.sections["nosecone"] = nosecone_section(part, seeds);
    made.add(nosecone_figures(part));
  } else {
    say(name, "cut and released");
    made.sections["release"] += release_section(part, seeds);
    made.add(release_figures(part));
  }
  if (name == "sheet") return;
  say(name, "stability points, overlap");
  made.sections["stability"] += stability_section(part, seeds);
  made.sections["overlap"] += overlap_section(part, seeds);
}

void run(const Arguments& arguments) {
  Made made;
  for (const std::string name : {"porthole", "nosecone", "sheet"})
    if (arguments.part.empty() || arguments.part == name) run_part(name, arguments, made);
  for (const auto& [section, text] : made.sections) {
    std::cout << "### " << section << "\n\n" << text << "\n";
    if (!arguments.out.empty() && arguments.is_whole()) put_between_markers(arguments.out, text, section);
  }
  if (!arguments.figures.empty()) write_figures(made.figures, arguments.figures);
}

}  // namespace

int main(int argc, char** argv) {
  return run_program([&] { run(parse(argc, argv)); }, std::cerr);
}
