// load_module() loads a module: a shared library beside the program that isn't needed to start it. [main]
#pragma once

#include <string>

#include <fmt/format.h>

#include "app/paths.h"
#include "base/result.h"
#include "base/system/executable_path.h"
#include "base/system/process.h"

namespace limber::app {

/// What to do if a module is missing, or can't be loaded, without a period at the end.
struct ModuleAdvice {
  std::string missing;
  std::string broken;
};

/// Returns the functions of a module. `Module`: a struct that begins with an int `version`; `function`: name of the
/// module's function without arguments that returns them.
template <class Module>
Result<const Module*> load_module(const std::string& name, const char* function, int version,
                                  const ModuleAdvice& advice) {
  const std::string file = module_file(name);
  if (file.empty())
    return Error{fmt::format("the module {} is not beside {}. {}", name, system::executable_path(), advice.missing)};
  std::string reason;
  const auto functions = reinterpret_cast<const Module* (*)()>(system::load_function(file, function, reason));
  const Module* const module = functions == nullptr ? nullptr : functions();
  if (module != nullptr && module->version == version) return module;
  if (module != nullptr) reason = "it belongs to another version of limber";
  return Error{fmt::format("{} can't be loaded: {}. {}", file, reason, advice.broken)};
}

}  // namespace limber::app
