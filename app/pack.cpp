// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "app/commands.h"
#include "app/open_session.h"
#include "sessions/session/session_pack.h"

namespace boresight::app {
namespace {

int pack(const std::string& session, const std::string& out) {
  const sessions::SessionDocument document = openToRead(session);
  for (const std::string& text : packSession(document.session(), document.file(), out)) note(text);
  print(out);
  return kDone;
}

}  // namespace

void addPack(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "pack", "Makes one archive of a session, its inputs and its runs, which opens elsewhere");
  auto session = std::make_shared<std::string>();
  auto out = std::make_shared<std::string>();
  command->add_option("session", *session, "Session file")->required()->type_name("FILE");
  command->add_option("--out", *out, "The zip archive that is made")->required()->type_name("FILE");
  command->callback([session, out, &exit_code] { exit_code = pack(*session, *out); });
}

}  // namespace boresight::app
