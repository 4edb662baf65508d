// SPDX-License-Identifier: Apache-2.0
#include "app/method_arguments.h"

#include <algorithm>

namespace boresight::app {

void MethodArguments::addTo(CLI::App& command, bool several) {
  CLI::Option* option =
      command.add_option("--method", methods,
                         std::string(several ? "How to localize, one after the other; there are: "
                                             : "How to localize; there are: ") +
                             sessions::methodNames());
  option->type_name("M")->default_str(sessions::kWhs)->check([](const std::string& name) {
    return sessions::isMethod(name)
               ? std::string()
               : "there is no method \"" + name + "\"; there are: " + sessions::methodNames();
  });
  if (!several) option->expected(1);
  command
      .add_option("--matcher", matcher,
                  "Command of the external matcher of the methods external, loftr-r and loftr-s, "
                  "e.g. \"node resources/matchers/loftr/loftr.js --model M.onnx\"")
      ->type_name("COMMAND");
}

bool MethodArguments::needsSetup() const {
  return std::any_of(methods.begin(), methods.end(),
                     [](const std::string& name) { return name != sessions::kWhs; });
}

sessions::MethodSetup MethodArguments::setup(const OptionArguments& options) const {
  for (const std::string& name : methods)
    if (sessions::needsMatcher(name) && matcher.empty())
      throw CLI::ValidationError("--matcher",
                                 "the method " + name + " needs its matcher's command");
  sessions::MethodSetup made;
  made.matcher = matcher;
  made.options = options.readMethodOptions();
  return made;
}

sessions::OptionList MethodArguments::changedOptions(const sessions::MethodOptions& options) const {
  if (!needsSetup()) return {};
  return sessions::changedOptions(options, sessions::MethodOptions());
}

}  // namespace boresight::app
