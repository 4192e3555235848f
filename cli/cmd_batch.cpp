#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <thread>

#include "acquisition/files/atomic_file.hpp"
#include "acquisition/types/error.hpp"
#include "cli/batch_folder.hpp"
#include "cli/batch_summary.hpp"
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/drawing.hpp"
#include "cli/edge_file.hpp"
#include "cli/interrupt.hpp"
#include "cli/run_inputs.hpp"
#include "cli/version.hpp"

namespace arris {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kTickMs = 500;  // how often the progress line is drawn, and Ctrl-C heard at the latest

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// A path as a word that no command line takes for an option.
std::string as_word(const fs::path& path) {
  const std::string text = path.string();
  return text.starts_with("-") ? "./" + text : text;
}

/// What every run of the batch shares.
RunArgs run_args(const BatchArgs& args) {
  RunArgs run;
  run.recipe = args.recipe;
  run.cell = args.cell;
  run.inspect_only = args.inspect_only;
  run.threads = args.threads > 0 ? args.threads : 1;
  return run;
}

/// The recipe of all runs, and the files that they share.
struct Shared {
  Recipe recipe;
  std::vector<InputFile> inputs;
};

/// Reads all that the runs share, so that what is wrong in it is told once and leaves no folder.
Shared read_shared(const RunArgs& run) {
  const Recipe recipe = read_recipe(run.recipe);
  if (recipe.contour.validation == "operator")
    throw Error(Fault::kInput, {.what = "a batch cannot ask an operator",
                                .where = run.recipe.string(),
                                .found = "contour.validation = \"operator\"",
                                .needed = "\"auto\"",
                                .next = "run these scans one by one: arris run --contours"});
  if (!recipe.scan.edge_calibration.empty()) (void)read_edge_file(recipe.scan.edge_calibration);
  std::vector<InputFile> inputs = hashed_inputs_but_scan(run, recipe, read_cell_for(run, recipe));
  (void)read_drawing(recipe, !run.inspect_only, run.threads);
  return {recipe, std::move(inputs)};
}

class Batch {
 public:
  Batch(const BatchArgs& args, const RunArgs& run, std::vector<InputFile> shared_inputs,
        std::vector<BatchScan> scans, const fs::path& folder)
      : force_(args.force),
        jobs_(args.jobs > 0 ? static_cast<std::size_t>(args.jobs)
                            : std::max(1U, std::thread::hardware_concurrency())),
        run_(run),
        shared_inputs_(std::move(shared_inputs)),
        scans_(std::move(scans)),
        folder_(folder),
        pool_(args.timeout_s),
        rows_(scans_.size()) {}

  /// Runs or keeps every scan. Throws Error(kInterrupted) and Error(kInput: disk full); what is done stays.
  std::vector<BatchRow> work() {
    remove_old_tables();
    while (next_ < scans_.size() || pool_.running() > 0) {
      if (interrupted()) stop();
      if (next_ < scans_.size() && pool_.running() < jobs_)
        begin_next();
      else
        for (const ChildEnd& end : pool_.wait(kTickMs)) finish(end);
      show();
    }
    return std::move(rows_);
  }

 private:
  /// A table that is there belongs to a batch that was finished.
  void remove_old_tables() const {
    std::error_code ignored;
    for (const char* name : {kSummaryName, kTimesName}) fs::remove(folder_.path() / name, ignored);
  }

  void begin_next() {
    const std::size_t index = next_++;
    const BatchScan& scan = scans_[index];
    std::string because;
    if (const auto earlier = read_run_result(folder_.run_folder(scan.name))) {
      because = force_ ? "--force" : changed(scan, *earlier);
      if (because.empty()) {
        rows_[index] = row_of(scan, *earlier);
        rows_[index].kept = true;
        ++kept_;
        count(rows_[index]);
        return;
      }
    }
    rows_[index].run_again_because = because;
    pool_.start(static_cast<int>(index), words_for(scan));
  }

  /// A scan that cannot be read is run, so that its run says why.
  [[nodiscard]] std::string changed(const BatchScan& scan, const RunResult& earlier) const {
    std::vector<InputFile> inputs = shared_inputs_;
    try {
      inputs.push_back(hashed_input("scan", scan.file));
    } catch (const Error&) {
      return "the scan cannot be read";
    }
    return difference(earlier, inputs, version());
  }

  [[nodiscard]] std::vector<std::string> words_for(const BatchScan& scan) const {
    std::vector<std::string> words{run_.inspect_only ? "inspect" : "run",
                                   as_word(run_.recipe),
                                   "--scan",
                                   as_word(scan.file),
                                   "--out",
                                   as_word(folder_.run_folder(scan.name)),
                                   "--threads",
                                   std::to_string(run_.threads),
                                   "--force"};
    if (run_.cell) words.insert(words.end(), {"--cell", as_word(*run_.cell)});
    return words;
  }

  void finish(const ChildEnd& end) {
    const auto index = static_cast<std::size_t>(end.id);
    const BatchScan& scan = scans_[index];
    const std::string because = rows_[index].run_again_because;
    auto result = read_run_result(folder_.run_folder(scan.name));
    const bool good = end.exit_code >= 0 && result && result->exit_code == end.exit_code &&
                      (end.exit_code != 3 && end.exit_code != 1);
    if (good) {
      rows_[index] = row_of(scan, std::move(*result));
      rows_[index].wall_s = end.wall_s;
      refuse_changed_inputs(*rows_[index].result);
    } else {
      rows_[index] = row_of_failure(scan, end);
      if (end.signal != 0) folder_.remove_leftovers(scan.name + ".part-");
      remove_outdated(scan, result.has_value());
      refuse_full_disk(rows_[index].message);
    }
    rows_[index].run_again_because = because;
    ++done_now_;
    count(rows_[index]);
  }

  void count(const BatchRow& row) { not_good_ += row.exit_code != 0 ? 1 : 0; }

  /// A failed run leaves no folder: neither may the one of other inputs that it was to replace.
  void remove_outdated(const BatchScan& scan, bool is_run_folder) const {
    std::error_code ignored;
    if (is_run_folder && !interrupted()) fs::remove_all(folder_.run_folder(scan.name), ignored);
  }

  /// All rows of a table are of the same recipe.
  void refuse_changed_inputs(const RunResult& result) const {
    std::vector<InputFile> inputs = shared_inputs_;
    for (const InputFile& input : result.inputs)
      if (input.role == "scan") inputs.push_back(input);
    const std::string what = difference(result, inputs, version());
    if (!what.empty())
      throw Error(Fault::kInput, {.what = "the inputs changed while the batch ran",
                                  .where = run_.recipe.string(),
                                  .found = what,
                                  .needed = "the same recipe, drawing, path and cell to the end",
                                  .next = "give the same command again: what is outdated is run again"});
  }

  void refuse_full_disk(const std::string& message) const {
    for (const int code : {ENOSPC, EDQUOT})
      if (message.find(std::strerror(code)) != std::string::npos)
        throw Error(
            Fault::kInput,
            {.what = "the batch stopped, for nothing more can be written",
             .where = folder_.path().string(),
             .found = std::string(std::strerror(code)) + ", " + done_words(),
             .next = "free space on the disk, then give the same command again: it goes on from here"});
  }

  [[noreturn]] void stop() {
    pool_.ask_to_stop();
    while (pool_.running() > 0)
      for (const ChildEnd& end : pool_.wait(-1))
        if (end.exit_code == 0 || end.exit_code == 4 || end.exit_code == 5 || end.exit_code == 7) ++done_now_;
    throw Error(Fault::kInterrupted, "stopped on request, " + done_words() +
                                         "; nothing half-written is left; next: the same command goes on "
                                         "from here");
  }

  [[nodiscard]] std::string done_words() const {
    return std::to_string(kept_ + done_now_) + " of " + std::to_string(scans_.size()) + " scans done";
  }

  void show() {
    BatchProgress now;
    now.done = kept_ + done_now_;
    now.total = scans_.size();
    now.not_good = not_good_;
    if (done_now_ > 0)
      now.left_s =
          seconds_since(began_) / static_cast<double>(done_now_) * static_cast<double>(now.total - now.done);
    for (const int id : pool_.running_ids()) now.running.push_back(scans_[static_cast<std::size_t>(id)].name);
    progress_.show(progress_text(now));
  }

  bool force_;
  std::size_t jobs_;
  RunArgs run_;
  std::vector<InputFile> shared_inputs_;
  std::vector<BatchScan> scans_;
  BatchFolder folder_;
  ChildPool pool_;  // after the folder: the children end before its lock
  std::vector<BatchRow> rows_;
  std::size_t next_ = 0, kept_ = 0, done_now_ = 0, not_good_ = 0;
  Clock::time_point began_ = Clock::now();
  console::Progress progress_;
};

}  // namespace

int run_batch(const BatchArgs& args) {
  const Clock::time_point began = Clock::now();
  const RunArgs run = run_args(args);
  const auto [recipe, inputs] = read_shared(run);
  std::vector<BatchScan> scans = batch_scans(args.scans, {recipe.part.cad});
  BatchRecord record;
  record.part_number = recipe.part.number;
  record.recipe = args.recipe;
  record.folder = args.out.value_or(args.recipe.stem().string() + ".batch");
  {
    Batch batch(args, run, inputs, std::move(scans), record.folder);
    record.rows = batch.work();
    record.total_s = seconds_since(began);
    write_file(record.folder / kTimesName, times_csv(record.rows));
    write_file(record.folder / kSummaryName, summary_csv(record.rows));
  }
  if (args.json)
    console::print(batch_json(record));
  else
    print_batch(record);
  return worst_exit_code(record.rows);
}

}  // namespace arris
