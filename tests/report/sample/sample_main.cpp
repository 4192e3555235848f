// Writes the files of a made-up run into a folder, to be looked at: sample_report DIR
#include <cstdio>
#include <fstream>
#include <string>

#include "../sample_record.hpp"
#include "report/picture.hpp"
#include "report/write_html.hpp"

namespace {

void put(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
  std::printf("%s %zu\n", path.c_str(), bytes.size());
}

}  // namespace

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : ".";
  using namespace arris;
  const RunRecord record = test::sample_record();
  put(folder + "/along.png", report::deviation_picture(record, report::Look::kAlong));
  put(folder + "/oblique.png", report::deviation_picture(record, report::Look::kOblique));
  put(folder + "/shift.png", report::path_shift_picture(record));
  put(folder + "/axes.png", report::path_axes_picture(record));
  put(folder + "/report.html", report::write_html(record));
  put(folder + "/refused.html", report::write_html(test::refused_record()));
  put(folder + "/bare.html", report::write_html(test::barely_started_record()));
  report::ContourDrawing drawing;
  drawing.title = "Contours of porthole.stl";
  drawing.subtitle = "open mesh, boundary loops";
  drawing.contours = record.cad_contours;
  drawing.mesh = &record.cad;
  put(folder + "/contours.png", report::contours_picture(drawing));
  put(folder + "/bare.png", report::deviation_picture(test::barely_started_record(), report::Look::kAlong));
}
