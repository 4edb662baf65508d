// SPDX-License-Identifier: Apache-2.0
#include "app/open_session.h"

#include "app/commands.h"
#include "sessions/io/errors.h"

namespace boresight::app {
namespace {

void sayNotices(const sessions::SessionDocument& document) {
  for (const std::string& text : document.notices()) note(text);
}

[[noreturn]] void failForEdits(const sessions::SessionDocument& document, const char* remedy) {
  throw sessions::InputError(
      document.file(), std::to_string(document.recovery()->edits.size()) + " edits " + remedy);
}

}  // namespace

sessions::SessionDocument openToRead(const std::string& file) {
  auto document = sessions::SessionDocument::open(file, sessions::Access::kReadOnly);
  sayNotices(document);
  if (document.recovery()) failForEdits(document, "are not saved yet; save the session first");
  return document;
}

sessions::SessionDocument openToEdit(const std::string& file, bool recover) {
  auto document = sessions::SessionDocument::open(file);
  if (document.readOnly()) throw sessions::OutputError(document.file(), document.readOnlyReason());
  sayNotices(document);
  if (document.recovery() && !recover)
    failForEdits(document,
                 "were never saved; take them with --recover, or open the session in the desktop "
                 "program");
  document.acceptRecovery();
  return document;
}

const sessions::SessionCase& requireCase(const sessions::SessionDocument& document,
                                         const std::string& case_id) {
  const sessions::SessionCase* found = document.session().findCase(case_id);
  if (found == nullptr)
    throw sessions::InputError(document.file(), "cases", "there is no case '" + case_id + "'");
  return *found;
}

const sessions::RunRecord& recordedRun(const sessions::SessionDocument& document,
                                       const std::string& beginning) {
  const sessions::RunRecord* found = nullptr;
  for (const sessions::RunRecord& run : document.session().runs) {
    if (!run.digest.starts_with(beginning)) continue;
    if (found != nullptr && found->digest != run.digest)
      throw sessions::InputError(document.file(), "runs",
                                 "more than one digest begins with " + beginning);
    found = &run;
  }
  if (found == nullptr)
    throw sessions::InputError(document.file(), "runs", "no digest begins with " + beginning);
  return *found;
}

}  // namespace boresight::app
