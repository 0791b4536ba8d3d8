// What draws.
#include "view/gl.h"

namespace limber {

std::string gl_driver() {
  const auto* const name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return name == nullptr ? "nothing" : name;
}

bool gl_is_software() {
  const std::string name = gl_driver();
  for (const char* software : {"llvmpipe", "softpipe", "swrast", "SwiftShader", "Software"}) {
    if (name.find(software) != std::string::npos) return true;
  }
  return false;
}

}  // namespace limber
