// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "sessions/session/session_document.h"

namespace boresight::app {

/// Opens a session that is only read; says on stderr what there is to know. InputError when edits
/// wait that were never saved.
sessions::SessionDocument openToRead(const std::string& file);

/// Opens a session that is changed. InputError as above unless they are to be taken up; OutputError
/// when somebody else has it open or it cannot be written.
sessions::SessionDocument openToEdit(const std::string& file, bool recover = false);

/// InputError when the session has no such case.
const sessions::SessionCase& requireCase(const sessions::SessionDocument& document,
                                         const std::string& case_id);

/// The recorded run whose digest begins like this; InputError when there is none, or more than one.
const sessions::RunRecord& recordedRun(const sessions::SessionDocument& document,
                                       const std::string& beginning);

}  // namespace boresight::app
