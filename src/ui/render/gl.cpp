// Creates and deletes OpenGL objects; the table of OpenGL versions, and error messages about missing drivers.
#include "ui/render/gl.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/system/process.h"

namespace limber::render {

namespace {

constexpr std::array<GlApiInfo, 3> kApis = {
    {{GlApi::core, "core", "OpenGL 3.3", 3, 3, "#version 330 core", 0, true, true, true, true, true},
     {GlApi::es, "es", "OpenGL ES 3.0", 3, 0, "#version 300 es", 0, false, false, false, false, true},
     {GlApi::gl31, "3.1", "OpenGL 3.1", 3, 1, "#version 140", 1, true, true, false, true, false}}};

std::string joined(const std::vector<std::string>& words, const char* last) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); i++)
    text += (i == 0 ? "" : i + 1 == words.size() ? fmt::format(" {} ", last) : ", ") + words[i];
  return text;
}

// message about the first missing client library; empty if all can be loaded
std::string missing_library() {
  constexpr std::array<std::array<const char*, 2>, 3> kPackages = {
      {{"libEGL.so.1", "libegl1"}, {"libGL.so.1", "libgl1"}, {"libGLESv2.so.2", "libgles2"}}};
  for (const auto& [library, package] : kPackages) {
    if (!system::load_library(library))
      return fmt::format("{} can't be loaded. On Debian: apt-get install {}", library, package);
  }
  return {};
}

}  // namespace

std::uint32_t make_gl_object(GlKind kind) {
  GLuint name = 0;
  switch (kind) {
    case GlKind::buffer:
      glGenBuffers(1, &name);
      break;
    case GlKind::vertex_array:
      glGenVertexArrays(1, &name);
      break;
    case GlKind::texture:
      glGenTextures(1, &name);
      break;
    case GlKind::renderbuffer:
      glGenRenderbuffers(1, &name);
      break;
    case GlKind::framebuffer:
      glGenFramebuffers(1, &name);
      break;
    case GlKind::program:
      name = glCreateProgram();
      break;
  }
  return name;
}

void delete_gl_object(GlKind kind, std::uint32_t name) {
  switch (kind) {
    case GlKind::buffer:
      glDeleteBuffers(1, &name);
      break;
    case GlKind::vertex_array:
      glDeleteVertexArrays(1, &name);
      break;
    case GlKind::texture:
      glDeleteTextures(1, &name);
      break;
    case GlKind::renderbuffer:
      glDeleteRenderbuffers(1, &name);
      break;
    case GlKind::framebuffer:
      glDeleteFramebuffers(1, &name);
      break;
    case GlKind::program:
      glDeleteProgram(name);
      break;
  }
}

const GlApiInfo& gl_api_info(GlApi api) { return kApis[static_cast<std::size_t>(api)]; }

std::vector<GlApi> gl_apis(std::string_view choice) {
  std::vector<GlApi> apis;
  for (const GlApi api : {GlApi::core, GlApi::es, GlApi::gl31}) {
    if (choice.empty() || choice == "auto" || choice == gl_api_info(api).option) apis.push_back(api);
  }
  return apis;
}

std::string gl_names(std::span<const GlApi> apis) {
  std::vector<std::string> names;
  for (const GlApi api : apis) names.emplace_back(gl_api_info(api).name);
  return joined(names, "or");
}

bool gl_can_load(GlApi api) {
  if (api == GlApi::es) return system::load_library("libGLESv2.so.2");
  return system::load_library("libOpenGL.so.0") || system::load_library("libGL.so.1");
}

std::string gl_context_error(std::span<const GlApi> apis, const std::vector<std::string>& offered) {
  const std::string missing = missing_library();
  const bool loads = std::any_of(apis.begin(), apis.end(), gl_can_load);
  if (!missing.empty() && (offered.empty() || !loads)) return missing;
  if (offered.empty())
    return "no OpenGL driver was found. On Debian: apt-get install libgl1-mesa-dri libegl-mesa0 libglx-mesa0";
  std::string fix = "update Mesa (on Debian the package libgl1-mesa-dri)";
  if (std::getenv("LIBGL_ALWAYS_SOFTWARE") == nullptr)
    fix = "draw in software (LIBGL_ALWAYS_SOFTWARE=1), or update the graphics driver";
  if (apis.size() < kApis.size()) fix = "set --gl (or LIMBER_GL) to auto, or " + fix;
  fix[0] = static_cast<char>(fix[0] - 'a' + 'A');
  return fmt::format("{} is needed, and the driver offers {}. {}{}", gl_names(apis), joined(offered, "and"),
                     missing.empty() ? "" : missing + ". Or: ", fix);
}

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

}  // namespace limber::render
