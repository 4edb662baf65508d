// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <memory>

#include "app/commands.h"
#include "app/open_session.h"
#include "sessions/io/atomic_file.h"
#include "sessions/io/errors.h"
#include "sessions/session/session_pack.h"

namespace boresight::app {
namespace {

int pack(const std::string& session, const std::string& out) {
  sessions::requireWritable(out);
  const sessions::SessionDocument document = openToRead(session);
  const sessions::SessionPack pack = sessions::planPack(document.session(), document.file());
  for (const std::string& text : pack.notes) note(text);
  for (const sessions::PackedFile& one : pack.files)
    std::cout << sessions::oneLine(one.name + "  from  " + one.file.string()) << "\n";
  std::cout << std::flush;
  sessions::writePack(pack, out);
  std::cout << out << std::endl;
  return kDone;
}

}  // namespace

void addPack(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "pack",
      "Makes one archive of a session, its inputs and its runs, which opens elsewhere. Lists each "
      "file first; a file that is not what the session says it is, or lies outside the folders of "
      "session and inputs, is refused");
  auto session = std::make_shared<std::string>();
  auto out = std::make_shared<std::string>();
  command->add_option("session", *session, "Session file")->required()->type_name("FILE");
  command->add_option("--out", *out, "The zip archive that is made")->required()->type_name("FILE");
  command->callback([session, out, &exit_code] { exit_code = pack(*session, *out); });
}

}  // namespace boresight::app
