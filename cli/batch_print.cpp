#include <algorithm>
#include <cmath>

#include "cli/batch_folder.hpp"
#include "cli/batch_summary.hpp"
#include "cli/console.hpp"
#include "report/number_text.hpp"

namespace arris {
namespace {

constexpr std::size_t kMostNamed = 10;  // more would scroll the counts off the screen; the table holds all

constexpr std::size_t kIndent = 13, kColumns = 80;

/// Lines under a heading, which stands on the first one only; folded at blanks to 80 columns.
class Section {
 public:
  explicit Section(std::string heading) : heading_(std::move(heading)) { heading_.resize(kIndent, ' '); }
  void line(std::string text) {
    for (std::size_t room = kColumns - kIndent; text.size() > room;) {
      std::size_t cut = text.rfind(' ', room);
      if (cut == std::string::npos || cut <= 2) cut = text.find(' ', room);
      if (cut == std::string::npos) break;
      put(text.substr(0, cut));
      text = "  " + text.substr(cut + 1);
    }
    put(text);
  }

 private:
  void put(const std::string& text) {
    console::print(heading_ + text);
    heading_.assign(kIndent, ' ');
  }
  std::string heading_;
};

std::string duration_words(double seconds) {
  if (seconds < 90.0) return std::to_string(std::lround(seconds)) + " s";
  if (seconds < 5400.0) return std::to_string(std::lround(seconds / 60.0)) + " min";
  return std::to_string(std::lround(seconds / 3600.0)) + " h";
}

std::string scans(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " scan" : " scans");
}

std::string mm(double value) {
  return report::fixed_text(value, 3) + " mm";
}

std::size_t count_if(const BatchRecord& record, bool (*is)(const BatchRow&)) {
  return static_cast<std::size_t>(std::count_if(record.rows.begin(), record.rows.end(), is));
}

void print_head(const BatchRecord& record) {
  console::print("batch        " + scans(record.rows.size()) + " of " + record.part_number);
  Section earlier("");
  const std::size_t kept = count_if(record, [](const BatchRow& row) { return row.kept; });
  if (kept > 0) earlier.line(scans(kept) + " complete from before and kept");
  std::vector<std::pair<std::string, std::size_t>> again;
  for (const BatchRow& row : record.rows) {
    if (row.run_again_because.empty()) continue;
    const auto known = std::find_if(again.begin(), again.end(),
                                    [&](const auto& one) { return one.first == row.run_again_because; });
    if (known == again.end())
      again.emplace_back(row.run_again_because, 1);
    else
      ++known->second;
  }
  for (const auto& [why, count] : again) earlier.line(scans(count) + " run again: " + why);
}

void print_counts(const BatchRecord& record) {
  Section outcome("outcome");
  const auto counts = outcome_counts(record.rows);
  for (auto it = counts.rbegin(); it != counts.rend(); ++it) {
    std::string count = std::to_string(it->second);
    count.insert(0, count.size() < 5 ? 5 - count.size() : 0, ' ');
    outcome.line(count + "  " + outcome_word(it->first) + " (" + std::to_string(it->first) + ")");
  }
}

void print_worst(const BatchRecord& record) {
  std::vector<const BatchRow*> bad;
  for (const BatchRow& row : record.rows)
    if (row.exit_code != 0) bad.push_back(&row);
  std::stable_sort(bad.begin(), bad.end(), [](const BatchRow* a, const BatchRow* b) {
    return severity_rank(a->exit_code) < severity_rank(b->exit_code);
  });
  Section worst("worst");
  for (std::size_t i = 0; i < std::min(bad.size(), kMostNamed); ++i)
    worst.line(bad[i]->scan.name + ": " + outcome_word(bad[i]->exit_code) +
               (bad[i]->message.empty() ? "" : ", " + bad[i]->message));
  if (bad.size() > kMostNamed)
    worst.line("and " + std::to_string(bad.size() - kMostNamed) + " more: see the table");
}

/// The scan with the largest value of a figure; nothing when none has it.
const BatchRow* largest(const BatchRecord& record, double RunResult::*figure) {
  const BatchRow* found = nullptr;
  for (const BatchRow& row : record.rows)
    if (row.result && std::isfinite(*row.result.*figure) &&
        (found == nullptr || *row.result.*figure > *found->result.*figure))
      found = &row;
  return found;
}

void print_figures(const BatchRecord& record) {
  Section edge("found edge");
  if (const BatchRow* row = largest(record, &RunResult::before_max_mm))
    edge.line("at most " + mm(row->result->before_max_mm) + " from the nominal placed rigidly (" +
              row->scan.name + ")");
  if (const BatchRow* row = largest(record, &RunResult::after_max_mm))
    edge.line("at most " + mm(row->result->after_max_mm) + " after the correction (" + row->scan.name + ")");
  Section shift("correction");
  if (const BatchRow* row = largest(record, &RunResult::max_correction_mm))
    shift.line("at most " + mm(row->result->max_correction_mm) + " (" + row->scan.name + ")");
}

void print_next(const BatchRecord& record) {
  Section next("next");
  for (const auto& [code, count] : outcome_counts(record.rows)) {
    switch (code) {
      case 1:
        next.line("Report what crashed, with its line above and its files. The same command tries it again.");
        break;
      case 6:
        next.line("See to the device, then give the same command again.");
        break;
      case 3:
        next.line("Mend or leave out the wrong inputs, then give the same command: the rest is kept.");
        break;
      case 5:
        next.line("Do not run the robot on refused parts. Open report.html in their folders.");
        break;
      case 4:
        next.line("Set the parts aside that are out of tolerance. Tell quality.");
        break;
      case 7:
        next.line("Scan the indeterminate parts again with more points, or measure by hand.");
        break;
      default:
        break;
    }
  }
  if (worst_exit_code(record.rows) == 0) next.line("Nothing else to do.");
}

}  // namespace

std::string progress_text(const BatchProgress& progress) {
  std::string text = std::to_string(progress.done) + "/" + scans(progress.total);
  if (progress.not_good > 0) text += ", " + std::to_string(progress.not_good) + " not good";
  if (progress.left_s && progress.done < progress.total)
    text += ", " + duration_words(*progress.left_s) + " left";
  const char* separator = "; running ";
  for (const std::string& name : progress.running) {
    text += separator + name;
    separator = ", ";
  }
  return text;
}

void print_batch(const BatchRecord& record) {
  print_head(record);
  print_counts(record);
  print_worst(record);
  print_figures(record);
  print_next(record);
  Section wrote("wrote");
  wrote.line((record.folder / kSummaryName).string() + "   (" + report::fixed_text(record.total_s, 1) +
             " s)");
  wrote.line((record.folder / "<scan>" / "report.html").string());
}

}  // namespace arris
