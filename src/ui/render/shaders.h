// Shaders: the GLSL programs from the folder shaders/ or embedded in the binary, with hot reload. If a program fails to
// compile, the error is logged and the last working one stays in use.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "model/file_stamp.h"
#include "ui/render/gl.h"

namespace limber::render {

/// [main]
class Shaders {
 public:
  /// `folder`: folder of shader files; empty: use the embedded ones. `defines`: lines prepended to every file, such as
  /// "#define TAPS 4\n". [main]
  Shaders(GlApi api, std::string folder, std::string defines)
      : api_(gl_api_info(api)), folder_(std::move(folder)), defines_(std::move(defines)) {}

  /// Builds all programs. Errors if even the embedded shaders don't compile on this driver. [main]
  Result<void> build_all();
  /// Rebuilds all programs if a file has changed; true if any was rebuilt. Logs errors. [main]
  bool reload();

  /// The OpenGL name of a program, such as "shape". [main]
  std::uint32_t program(std::string_view name) const;
  /// Location of a uniform; -1 if the program does not use it. [main]
  int uniform(std::string_view name, const char* uniform) const;
  /// The error of the last (re)build; empty if it succeeded. [main]
  const std::string& error() const { return error_; }

 private:
  struct Program {
    std::string vertex;  // file name
    std::string fragment;
    std::string defines;
    GlProgram program;
  };
  std::string source_of(const std::string& file, bool embedded) const;
  Result<GlProgram> build(const Program& files, bool embedded) const;
  Result<std::uint32_t> compile(std::uint32_t kind, const std::string& file, const std::string& defines,
                                bool embedded) const;
  std::string with_file_names(const std::string& log, const std::string& file, bool embedded) const;
  void report_error(const std::string& text);

  const GlApiInfo& api_;
  std::string folder_;
  std::string defines_;
  std::map<std::string, Program, std::less<>> programs_;
  std::map<std::string, model::FileStamp, std::less<>> stamps_;
  std::string error_;
};

}  // namespace limber::render
