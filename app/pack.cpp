// SPDX-License-Identifier: Apache-2.0

#include "app/commands.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/session/session_pack.h"

namespace boresight::app {
namespace {

struct PackArguments {
  std::string session, out;

  void addTo(CLI::App& command) {
    addFile(command, "session", session, "Session file")->required();
    addFile(command, "--out", out, "Zip archive to create")->required();
  }
};

int writePack(const PackArguments& arguments) {
  sessions::requireWritable(arguments.out);
  const sessions::SessionDocument document = openToRead(arguments.session);
  const sessions::SessionPack pack = sessions::planPack(document.session(), document.file());
  for (const std::string& text : pack.notes) note(text);
  for (const sessions::PackedFile& packed_file : pack.files)
    print(packed_file.name + " from " + packed_file.file.string());
  sessions::writePack(pack, arguments.out);
  print(arguments.out);
  return kDone;
}

}  // namespace

void addPack(CLI::App& app, int& exit_code) {
  addCommand(app, exit_code, "pack",
             "Packs a session, its inputs and its runs into one archive for another machine. "
             "Prints each file first. Refuses a file whose hash differs from the session's, or "
             "that lies outside the folders of session and inputs",
             writePack);
}

}  // namespace boresight::app
