// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "sessions/session/session.h"

namespace boresight::sessions {

/// A change of a session, to be performed on its value of the moment. May throw InputError.
using SessionEdit = std::function<Session(const Session&)>;

/// The edit that led from `before` to `after`: all parts that differ, by case, decision and run. It
/// leaves all other parts of the session that it is performed on as they are.
SessionEdit editBetween(const Session& before, const Session& after);

}  // namespace boresight::sessions
