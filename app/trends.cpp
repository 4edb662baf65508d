// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iostream>
#include <iterator>

#include "app/commands.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/report/trends.h"

namespace boresight::app {
namespace {

struct TrendArguments {
  std::vector<std::string> sessions;
  std::string csv, pdf;

  void addTo(CLI::App& command) {
    addFile(command, "sessions", sessions, "Session files, in the order of time")->required();
    addFile(command, "--csv", csv, "Writes the same as CSV, with sigmas");
    addFile(command, "--pdf", pdf, "Writes plots, a page a station");
  }
};

int trends(const TrendArguments& arguments) {
  requireWritable({arguments.csv, arguments.pdf});
  std::vector<std::string> remarks;
  std::vector<sessions::TrendPoint> points;
  for (const std::string& file : arguments.sessions)
    std::ranges::move(sessions::trendOf(openToRead(file).session(), file, remarks),
                      std::back_inserter(points));
  sessions::flagOutliers(points);
  for (const std::string& remark : remarks) note(remark);
  std::cout << sessions::trendTable(points) << std::flush;
  if (!arguments.csv.empty())
    sessions::writeFileAtomically(arguments.csv, sessions::trendCsv(points));
  if (!arguments.pdf.empty())
    sessions::writeFileAtomically(arguments.pdf, sessions::trendPdf(points));
  return kDone;
}

}  // namespace

void addTrends(CLI::App& app, int& exit_code) {
  addCommand(
      app, exit_code, "trends",
      "Lists corrections, residuals and checks of stations over many sessions, one a sol, and "
      "flags runs that stand out",
      trends);
}

}  // namespace boresight::app
