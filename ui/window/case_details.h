// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <QImage>
#include <QObject>
#include <QTimer>

#include "core/geometry/pose.h"
#include "sessions/session/session.h"
#include "ui/panels/case/cases_panel.h"

namespace boresight::ui {

/// The session's cases as the list of cases shows them. `running` is the id of the one at work, or
/// empty; `file` is the session's, for messages; `known` is kept from one call to the next.
std::vector<CaseRow> caseRows(const sessions::Session& session, const QString& running,
                              const std::filesystem::path& file, sessions::StaleRuns& known);

class TaskRunner;

/// What the list of cases shows and the session does not hold: small pictures of the images, and
/// how far the results of the latest runs are from the truth. Files are read off the UI's thread,
/// each once and one at a time, so that whatever a person asks for comes in between.
class CaseDetails : public QObject {
  Q_OBJECT

 public:
  explicit CaseDetails(TaskRunner& tasks, QObject* parent = nullptr);

  /// Takes note of what is to be read; what is known already is kept.
  void setSession(const sessions::Session& session);
  /// Adds what is known by now to rows of the session.
  void fill(std::vector<CaseRow>& rows) const;

 Q_SIGNALS:
  /// There is more to fill in.
  void changed();

 private:
  void readNext();
  void tellSoon();
  bool readThumbnail(const sessions::ImageInput& image);
  bool readPose(const sessions::RunRecord& run);
  void fillErrors(const sessions::SessionCase& session_case, CaseRow& row) const;

  TaskRunner& tasks_;
  sessions::Session session_;
  std::map<std::string, QImage> thumbnails_;          ///< by hash of the file; null: cannot be read
  std::map<std::string, std::optional<Pose>> poses_;  ///< by digest of the run; nothing: no result
  bool reading_ = false;
  std::size_t next_ = 0;  ///< case to look at next, for its picture, then again for its run
  QTimer pause_;          ///< between two signals
};

}  // namespace boresight::ui
