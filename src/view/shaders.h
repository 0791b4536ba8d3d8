// Shaders: the programs of shaders/, from that folder where it is there, else from inside the program; made anew when a
// file is saved. One that is broken says why, and the last good one draws on.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "model/file_stamp.h"
#include "view/gl.h"

namespace limber {

class Shaders {
 public:
  /// `folder`: empty: only those inside the program are used. `defines`: lines in front of every file, such as
  /// "#define TAPS 4\n". [main]
  Shaders(GlApi api, std::string folder, std::string defines)
      : api_(gl_api_info(api)), folder_(std::move(folder)), defines_(std::move(defines)) {}

  /// Makes all programs. An error: even those inside the program don't compile here. [main]
  Result<void> start();
  /// Makes those anew whose files were saved since; true when one has changed. Faults are logged. [main]
  bool renew();

  /// The program of `name`.vert and `name`.frag. [main]
  GLuint program(std::string_view name) const;
  /// Where a uniform is; -1: the program does not use it. [main]
  GLint uniform(std::string_view name, const char* uniform) const;
  /// What was wrong when a file was read last; empty: nothing. [main]
  const std::string& fault() const { return fault_; }

 private:
  struct Made {
    std::string vertex;  // files' names
    std::string fragment;
    std::string defines;
    GlProgram program;
  };
  std::string text_of(const std::string& file, bool inside) const;
  Result<GlProgram> build(const Made& wanted, bool inside) const;
  Result<GLuint> compile(GLenum kind, const std::string& file, const std::string& defines, bool inside) const;
  std::string placed(const std::string& log, const std::string& file, bool inside) const;
  void complain(const std::string& text);

  const GlApiInfo& api_;
  std::string folder_;
  std::string defines_;
  std::map<std::string, Made, std::less<>> made_;
  std::map<std::string, FileStamp, std::less<>> stamps_;
  std::string fault_;
};

}  // namespace limber
