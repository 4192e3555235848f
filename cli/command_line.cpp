// The only file that knows CLI11.
#include "cli/command_line.hpp"

#include <CLI/CLI.hpp>
#include <functional>

#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/key_table.hpp"
#include "cli/version.hpp"

namespace arris {
namespace {

/// What every command shares.
struct Common {
  bool json = false;
  int threads = 0;
};

/// The command that was chosen, to be run when the whole line has been read.
using Chosen = std::function<int()>;

CLI::App* add_command(CLI::App& app, const std::string& name, const std::string& about,
                      const std::string& example) {
  CLI::App* command = app.add_subcommand(name, about)->group("Commands");
  command->footer("Example:\n  " + example + "\n\nEvery command takes --threads N, --json and --help.");
  return command;
}

void add_run(CLI::App& app, const Common& common, Chosen& chosen, bool inspect) {
  const auto args = std::make_shared<RunArgs>();
  args->inspect_only = inspect;
  CLI::App* command =
      inspect ? add_command(app, "inspect",
                            "Compare a scan with its drawing: shape, contours, report; no tool path",
                            "arris inspect bracket.toml --scan part7.ply --out part7")
              : add_command(app, "run", "The main job: scan in; corrected path, robot program and report out",
                            "arris run bracket.toml --scan part7.ply --cell cell.toml");
  command->add_option("RECIPE", args->recipe, "recipe of the part number (arris recipe print explains it)")
      ->required()
      ->option_text(" ");
  command->add_option("--scan", args->scan, "scan of the part (ply, stl, pcd, off, text)")
      ->required()
      ->option_text("FILE (required)");
  command->add_option("--out", args->out, "folder of the results; <scan>.arris unless given")
      ->option_text("DIR");
  command->add_option("--contours", args->contours, "the operator's choice, from arris contours --accept")
      ->option_text("FILE");
  command
      ->add_option("--targets", args->targets,
                   "points of the fixture targets that the scanner's software gave (csv)")
      ->option_text("FILE");
  if (!inspect)
    command->add_option("--cell", args->cell, "station file; replaces the one the recipe names")
        ->option_text("FILE");
  command->add_flag("--force", args->force, "replace the folder of the results when it exists");
  command->callback([args, &common, &chosen] {
    args->json = common.json;
    args->threads = common.threads;
    chosen = [args] { return run_main_job(*args); };
  });
}

void add_batch(CLI::App& app, const Common& common, Chosen& chosen) {
  const auto args = std::make_shared<BatchArgs>();
  CLI::App* command =
      add_command(app, "batch", "Run many stored scans with one recipe; resumes where it was stopped",
                  "arris batch bracket.toml scans/ --out may --jobs 4\n"
                  "  arris batch bracket.toml part7.ply part8.ply\n"
                  "  arris batch bracket.toml @list.txt --inspect");
  command->add_option("RECIPE", args->recipe, "recipe of the part number")->required()->option_text(" ");
  command
      ->add_option("SCAN", args->scans, "scan files, folders of scans, or @FILE: a list with a path a line")
      ->required()
      ->option_text("...");
  command
      ->add_option("--out", args->out,
                   "folder of the batch, a run folder a scan in it; <recipe>.batch unless given")
      ->option_text("DIR");
  command->add_option("--jobs", args->jobs, "scans at a time; 0: one a core")
      ->check(CLI::Range(0, 1024))
      ->option_text("N");
  command
      ->add_option("--timeout", args->timeout_s,
                   "end a scan that runs longer, its row says so; 0 (unless given): never")
      ->check(CLI::Range(0, 1000000))
      ->option_text("SECONDS");
  command->add_option("--cell", args->cell, "station file; replaces the one the recipe names")
      ->option_text("FILE");
  command->add_flag("--inspect", args->inspect_only, "shape and contours alone, no tool path");
  command->add_flag("--force", args->force, "run all scans again, those that are complete too");
  command->callback([args, &common, &chosen] {
    args->json = common.json;
    args->threads = common.threads;
    chosen = [args] { return run_batch(*args); };
  });
}

void add_contours(CLI::App& app, const Common& common, Chosen& chosen) {
  const auto args = std::make_shared<ContoursArgs>();
  CLI::App* command =
      add_command(app, "contours", "List and draw the contours of a mesh or scan; choose among them",
                  "arris contours part7.ply --png loops.png --accept 1,4 --out contours.json");
  command->add_option("FILE", args->file, "mesh of the drawing, or a scan")->required()->option_text(" ");
  command->add_option("--recipe", args->recipe, "recipe whose units and [contour] options are used")
      ->option_text("FILE");
  command
      ->add_option("--units", args->units,
                   "unit of the file when there is no recipe: mm (unless given), cm, m, inch")
      ->check(CLI::IsMember({"mm", "cm", "m", "inch"}))
      ->option_text("UNIT");
  command->add_option("--accept", args->accept, "ids to accept; all others are rejected")
      ->delimiter(',')
      ->option_text("IDS");
  command->add_option("--out", args->out, "write the choice here, for arris run --contours")
      ->option_text("FILE");
  command->add_option("--png", args->png, "draw the contours")->option_text("FILE");
  command->callback([args, &common, &chosen] {
    args->json = common.json;
    args->threads = common.threads;
    chosen = [args] { return run_contours(*args); };
  });
}

void add_calibrate_edge(CLI::App& calibrate, const Common& common, Chosen& chosen) {
  const auto args = std::make_shared<CalibrateEdgeArgs>();
  CLI::App* command = add_command(
      calibrate, "edge", "Where a scanner shows edges, from scans of a hole or plate of known size",
      "arris calibrate edge gauge.toml --scan g1.ply g2.ply g3.ply --scanner \"Hall 2\" --out edge.toml\n"
      "  arris calibrate edge gauge.toml --scan g4.ply --scanner \"Hall 2\" --size-sd 0.005 --out edge.toml "
      "--force\n\nThen name it in the recipes of the parts: [scan] edge_calibration = \"edge.toml\"");
  command->add_option("RECIPE", args->recipe, "recipe of the reference: its drawing, units and contours")
      ->required()
      ->option_text(" ");
  command->add_option("--scan", args->scans, "scans of the reference, at least one; three are better")
      ->required()
      ->option_text("FILE ... (required)");
  command->add_option("--scanner", args->scanner, "which scanner this is, as reports shall call it")
      ->required()
      ->option_text("NAME (required)");
  command->add_option("--serial", args->serial, "its serial number")->option_text("NUMBER");
  command
      ->add_option(
          "--size-sd", args->size_sd_mm,
          "standard deviation of the reference's size, edge to edge of the material: 0.01 unless given")
      ->check(CLI::Range(0.0, 10.0))
      ->option_text("MM");
  command->add_option("--out", args->out, "where the calibration is written")
      ->required()
      ->option_text("FILE (required)");
  command->add_flag("--force", args->force, "replace a former calibration of that name");
  command->callback([args, &common, &chosen] {
    args->json = common.json;
    args->threads = common.threads;
    chosen = [args] { return run_calibrate_edge(*args); };
  });
}

void add_calibrate(CLI::App& app, const Common& common, Chosen& chosen) {
  CLI::App* command = add_command(
      app, "calibrate", "Measure what is a property of the station",
      "arris calibrate edge gauge.toml --scan g1.ply g2.ply --scanner \"Hall 2\" --out edge.toml");
  command->require_subcommand(1);
  add_calibrate_edge(*command, common, chosen);
}

void add_map(CLI::App& app, const Common& common, Chosen& chosen) {
  const auto args = std::make_shared<MapArgs>();
  CLI::App* command =
      add_command(app, "map", "Lay a whole scan on its drawing and write the deviation of every point",
                  "arris map bracket.toml --scan part7.ply --out part7.map.ply");
  command->add_option("RECIPE", args->recipe, "recipe of the part number")->required()->option_text(" ");
  command->add_option("--scan", args->scan, "scan of the part (ply, stl, pcd, off, text)")
      ->required()
      ->option_text("FILE (required)");
  command->add_option("--out", args->out, "file of the map; <scan>.map.ply unless given")
      ->option_text("FILE.ply");
  command->callback([args, &common, &chosen] {
    args->json = common.json;
    args->threads = common.threads;
    chosen = [args] { return run_map(*args); };
  });
}

void add_info(CLI::App& app, const Common& common, Chosen& chosen) {
  const auto args = std::make_shared<InfoArgs>();
  CLI::App* command = add_command(app, "info", "What a scan or mesh file holds", "arris info part7.ply");
  command->add_option("FILE", args->file, "scan or mesh")->required()->option_text(" ");
  command->callback([args, &common, &chosen] {
    args->json = common.json;
    chosen = [args] { return run_info(*args); };
  });
}

void add_recipe_check(CLI::App& recipe, const Common& common, Chosen& chosen) {
  const auto args = std::make_shared<RecipeCheckArgs>();
  CLI::App* command =
      add_command(recipe, "check", "Say all that is wrong in a recipe, in the files and the cell it names",
                  "arris recipe check bracket.toml");
  command->add_option("FILE", args->file, "recipe, or cell with --cell")->required()->option_text(" ");
  command->add_flag("--cell", args->is_cell, "the file is a cell");
  command->callback([args, &common, &chosen] {
    args->json = common.json;
    args->threads = common.threads;
    chosen = [args] { return run_recipe_check(*args); };
  });
}

void add_recipe_print(CLI::App& recipe, const Common& common, Chosen& chosen) {
  const auto args = std::make_shared<RecipePrintArgs>();
  CLI::App* command =
      add_command(recipe, "print", "Print a recipe with every key, its value and what it means",
                  "arris recipe print bracket.toml > full.toml");
  command->add_option("FILE", args->file, "recipe, or cell with --cell; the defaults without it")
      ->option_text(" ");
  command->add_flag("--cell", args->is_cell, "print a cell");
  command->callback([args, &common, &chosen] {
    args->json = common.json;
    chosen = [args] { return run_recipe_print(*args); };
  });
}

void add_recipe_new(CLI::App& recipe, const Common& common, Chosen& chosen) {
  const auto args = std::make_shared<RecipeNewArgs>();
  CLI::App* command =
      add_command(recipe, "new", "Write a first recipe for a drawing",
                  "arris recipe new --cad bracket.stl --path deburr.csv --part A-1042 > bracket.toml");
  command->add_option("--cad", args->cad, "mesh of the drawing")->required()->option_text("FILE (required)");
  command->add_option("--path", args->path, "nominal tool path (csv)")->option_text("FILE");
  command->add_option("--part", args->part, "part number; the name of the mesh unless given")
      ->option_text("NUMBER");
  command->add_option("--units", args->units, "unit of the mesh and the scans: mm, cm, m, inch")
      ->check(CLI::IsMember({"mm", "cm", "m", "inch"}))
      ->option_text("UNIT");
  command->add_option("--out", args->out, "write the recipe here instead of to the screen")
      ->option_text("FILE");
  command->callback([args, &common, &chosen] {
    args->json = common.json;
    chosen = [args] { return run_recipe_new(*args); };
  });
}

void add_recipe(CLI::App& app, const Common& common, Chosen& chosen) {
  CLI::App* command =
      add_command(app, "recipe", "Check, print or begin a recipe", "arris recipe check bracket.toml");
  command->require_subcommand(1);
  add_recipe_check(*command, common, chosen);
  add_recipe_print(*command, common, chosen);
  add_recipe_new(*command, common, chosen);
}

void add_demo(CLI::App& app, const Common& common, Chosen& chosen) {
  const auto args = std::make_shared<DemoArgs>();
  CLI::App* command =
      add_command(app, "demo", "The main job on a built-in part", "arris demo --out /tmp/demo");
  command
      ->add_option("--out", args->out,
                   "folder of the demo, arris-demo unless given; one that it made before is replaced")
      ->option_text("DIR");
  command->add_option("--part", args->part, "built-in part: porthole (unless given), nosecone, sheet")
      ->check(CLI::IsMember({"porthole", "nosecone", "sheet"}))
      ->option_text("NAME");
  command->callback([args, &common, &chosen] {
    args->json = common.json;
    args->threads = common.threads;
    chosen = [args] { return run_demo(*args); };
  });
}

std::vector<std::string> names_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

/// The command that the line was read as, as far as it was.
const CLI::App& innermost(const CLI::App& app) {
  const CLI::App* found = &app;
  while (!found->get_subcommands().empty()) found = found->get_subcommands().front();
  return *found;
}

std::vector<std::string> options_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* level = &app; level != nullptr; level = level->get_parent())
    for (const CLI::Option* option : level->get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// The full name of a command: "arris recipe check".
std::string full_name(const CLI::App& app) {
  return app.get_parent() == nullptr ? "arris" : full_name(*app.get_parent()) + " " + app.get_name();
}

/// The first word that no option or command took, with what was probably meant.
ErrorText unexpected(const CLI::App& app, const std::string& word) {
  const CLI::App& command = innermost(app);
  const bool option = word.starts_with("-");
  const std::vector<std::string> names = names_of(command);
  ErrorText text{option ? full_name(command) + " has no option " + word
                        : (names.empty() ? full_name(command) + " does not take " + quote(word)
                                         : full_name(command) + " has no command " + quote(word))};
  const std::string near = nearest_name(word.substr(0, word.find('=')), option ? options_of(command) : names);
  text.next = near.empty() ? full_name(command) + " --help" : "did you mean " + near + "?";
  return text;
}

[[noreturn]] void usage_error(const CLI::App& app, const CLI::ParseError& error) {
  if (const std::vector<std::string> rest = app.remaining(true); !rest.empty())
    throw Error(Fault::kUsage, unexpected(app, rest.front()));
  ErrorText text{error.what()};
  text.next = full_name(innermost(app)) + " --help";
  throw Error(Fault::kUsage, text);
}

}  // namespace

int run_command_line(int argc, const char* const* argv) {
  CLI::App app(
      "Arris finds how a scanned part lies and is bent, corrects the tool path, and says how good it is.",
      "arris");
  Common common;
  Chosen chosen;
  app.set_version_flag("--version", version());
  app.add_flag("--json", common.json, "results as JSON on stdout");
  app.add_option("--threads", common.threads, "threads to use; 0: one a core")
      ->check(CLI::Range(0, 1024))
      ->option_text("N");
  app.fallthrough();
  app.require_subcommand(1);
  app.get_formatter()->label("SUBCOMMAND", "COMMAND");
  app.footer(
      "Example:\n  arris run bracket.toml --scan part7.ply --out part7\n\narris COMMAND --help says more.");
  add_run(app, common, chosen, false);
  add_run(app, common, chosen, true);
  add_batch(app, common, chosen);
  add_map(app, common, chosen);
  add_contours(app, common, chosen);
  add_calibrate(app, common, chosen);
  add_info(app, common, chosen);
  add_recipe(app, common, chosen);
  add_demo(app, common, chosen);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    console::print(app.help());
    return 0;
  } catch (const CLI::CallForVersion&) {
    console::print(version());
    return 0;
  } catch (const CLI::ParseError& error) {
    usage_error(app, error);
  }
  return chosen();
}

}  // namespace arris
