// Reads, compiles and links shaders; adds file names to the line numbers in the driver's messages.
#include "ui/render/shaders.h"

#include <epoxy/gl.h>

#include <array>
#include <fstream>
#include <iterator>
#include <span>

#include <fmt/format.h>

#include "base/embedded.h"
#include "base/log/log.h"
#include "base/text.h"

namespace limber::render {

/// The files of shaders/, embedded by the build.
std::span<const EmbeddedFile> shader_files();

namespace {

constexpr const char* kCommon = "common.glsl";
constexpr int kFileLineBase = 10000;  // added to a file's own line numbers, to distinguish them from those of kCommon

struct ProgramFiles {
  const char* name;
  const char* vertex;
  const char* fragment;
  const char* defines = "";
  bool GlApiInfo::*replaced_feature = nullptr;  // only built if the API lacks this feature
};
const std::array<ProgramFiles, 11> kPrograms = {
    {{"shape", "shape.vert", "shape.frag"},
     {"colored", "shape.vert", "shape.frag", "#define COLORED\n"},
     {"depth", "shape.vert", "depth.frag"},
     {"floor", "floor.vert", "floor.frag"},
     {"sky", "sky.vert", "sky.frag"},
     {"beam", "beam.vert", "beam.frag"},
     {"overlay", "overlay.vert", "overlay.frag"},
     {"mirrored", "shape.vert", "shape.frag", "#define MIRRORED\n", &GlApiInfo::clip_distance},
     {"mirrored_colored", "shape.vert", "shape.frag", "#define MIRRORED\n#define COLORED\n", &GlApiInfo::clip_distance},
     {"ground", "shape.vert", "ground.frag", "#define GROUND\n", &GlApiInfo::depth_clamp},
     {"encode", "encode.vert", "encode.frag", "", &GlApiInfo::srgb_switch}}};

// the start of every shader: version, extensions, default precisions, CLIP_DISTANCE
std::string header(const GlApiInfo& api) {
  std::string text = fmt::format("{}\n", api.glsl);
  if (!api.attribute_slot) text += "#extension GL_ARB_explicit_attrib_location : require\n";
  if (std::string_view(api.glsl).ends_with(" es")) {
    for (const char* type : {"float", "int", "sampler2D", "sampler2DShadow"})
      text += fmt::format("precision highp {};\n", type);
  }
  return text + fmt::format("#define CLIP_DISTANCE {:d}\n", static_cast<int>(api.clip_distance));
}

template <class Get>
std::string log_of(GLuint name, Get get) {
  std::array<char, 2048> text{};
  GLsizei length = 0;
  get(name, static_cast<GLsizei>(text.size()), &length, text.data());
  return std::string(text.data(), static_cast<std::size_t>(length));
}

}  // namespace

std::string Shaders::source_of(const std::string& file, bool embedded) const {
  if (!embedded) {
    std::ifstream in(folder_ + "/" + file, std::ios::binary);
    if (in) return {std::istreambuf_iterator<char>(in), {}};
  }
  const EmbeddedFile* const found = find_embedded(shader_files(), file);
  return found == nullptr ? std::string() : std::string(found->text);
}

// drivers report "0:12(5): error: …" or "0(12) : error …"; lines of the file itself start at kFileLineBase
std::string Shaders::with_file_names(const std::string& log, const std::string& file, bool embedded) const {
  std::string out;
  for (std::string_view line : split(log, '\n')) {
    if (line.empty()) continue;
    if (!out.empty()) out += '\n';
    const std::size_t end = line.find_first_not_of("0123456789", 2);
    const bool counted = line.size() > 2 && line[0] == '0' && (line[1] == ':' || line[1] == '(') && end > 2;
    const auto number = counted ? parse_number(line.substr(2, end - 2)) : std::nullopt;
    if (number) {
      const bool in_file = *number > kFileLineBase;
      out += fmt::format("{}/{}:{}{}", embedded ? "shaders" : folder_, in_file ? file : kCommon,
                         *number - (in_file ? kFileLineBase : 0), end < line.size() ? line.substr(end) : "");
    } else {
      out += line;
    }
  }
  return printable(shortened(out, 1000));
}

Result<GLuint> Shaders::compile(GLenum kind, const std::string& file, const std::string& defines, bool embedded) const {
  const int first = 1 - api_.line_offset;
  const std::string text = fmt::format("{}{}{}#line {}\n{}\n#line {}\n{}", header(api_), defines_, defines, first,
                                       source_of(kCommon, embedded), kFileLineBase + first, source_of(file, embedded));
  const char* const source = text.c_str();
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint ok = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok == GL_TRUE) return shader;
  const std::string log = log_of(shader, glGetShaderInfoLog);
  glDeleteShader(shader);
  return Error{with_file_names(log, file, embedded)};
}

Result<GlProgram> Shaders::build(const Program& files, bool embedded) const {
  const Result<GLuint> vertex = compile(GL_VERTEX_SHADER, files.vertex, files.defines, embedded);
  if (!vertex) return Error{vertex.error()};
  const Result<GLuint> fragment = compile(GL_FRAGMENT_SHADER, files.fragment, files.defines, embedded);
  if (!fragment) {
    glDeleteShader(*vertex);
    return Error{fragment.error()};
  }
  GlProgram program(glCreateProgram());
  for (const GLuint shader : {*vertex, *fragment}) {
    glAttachShader(*program, shader);
    glDeleteShader(shader);
  }
  glLinkProgram(*program);
  GLint ok = GL_FALSE;
  glGetProgramiv(*program, GL_LINK_STATUS, &ok);
  if (ok != GL_TRUE) {
    return Error{fmt::format("shaders {} and {} can't be linked: {}", files.vertex, files.fragment,
                             with_file_names(log_of(*program, glGetProgramInfoLog), files.fragment, embedded))};
  }
  if (const GLuint block = glGetUniformBlockIndex(*program, "Frame"); block != GL_INVALID_INDEX)
    glUniformBlockBinding(*program, block, 0);
  glUseProgram(*program);
  constexpr std::array<const char*, 3> kTextures = {"shadow_depth", "ground_depth", "base_color"};
  for (std::size_t i = 0; i < kTextures.size(); i++)
    glUniform1i(glGetUniformLocation(*program, kTextures[i]), static_cast<GLint>(i));
  return program;
}

void Shaders::report_error(const std::string& text) {
  if (error_ == text) return;
  error_ = text;
  if (!text.empty()) log_error("{}\nthe previous shaders stay in use", text);
}

Result<void> Shaders::build_all() {
  std::string error;
  for (const ProgramFiles& files : kPrograms) {
    if (files.replaced_feature != nullptr && api_.*files.replaced_feature) continue;
    Program& entry = programs_[files.name];
    entry = {files.vertex, files.fragment, files.defines, {}};
    Result<GlProgram> program = build(entry, folder_.empty());
    if (!program && !folder_.empty()) {
      error = program.error();
      program = build(entry, true);
    }
    if (!program) return Error{fmt::format("OpenGL rejects the embedded shaders: {}", program.error())};
    entry.program = std::move(*program);
  }
  if (!folder_.empty()) {
    for (const EmbeddedFile& file : shader_files())
      stamps_[std::string(file.name)] = model::FileStamp(folder_ + "/" + std::string(file.name));
  }
  report_error(error);
  return {};
}

bool Shaders::reload() {
  bool changed = false;
  for (auto& [file, stamp] : stamps_) {
    const std::string path = folder_ + "/" + file;
    if (stamp.is_current(path)) continue;
    stamp = model::FileStamp(path);
    changed = true;
  }
  if (!changed) return false;
  bool any_rebuilt = false;
  std::string error;
  for (auto& [name, entry] : programs_) {
    Result<GlProgram> program = build(entry, false);
    if (!program) {
      error = program.error();
      continue;
    }
    entry.program = std::move(*program);
    any_rebuilt = true;
  }
  if (error.empty()) log_info("shaders: reloaded");
  report_error(error);
  return any_rebuilt;
}

GLuint Shaders::program(std::string_view name) const { return *programs_.find(name)->second.program; }

GLint Shaders::uniform(std::string_view name, const char* uniform) const {
  return glGetUniformLocation(program(name), uniform);
}

}  // namespace limber::render
