// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <QString>

namespace boresight::ui {

/// A page as the manual's index lists it.
struct ManualPage {
  QString chapter;  ///< the heading that it stands under
  QString title;
  QString file;  ///< name in the manual's folder: "annotate.md"
};

/// The manual's folder: share/boresight/manual beside an installed program or in the build tree of
/// one that was not installed. "" when there is none.
QString manualFolder();

/// The pages in the order of index.md, the index itself first; empty when it cannot be read.
std::vector<ManualPage> manualPages(const QString& folder);

/// Text of a file in UTF-8; "" when it cannot be read.
QString manualText(const QString& file);

/// By which a link names a heading: "Where is it?" is "where-is-it".
QString headingAnchor(const QString& heading);

}  // namespace boresight::ui
