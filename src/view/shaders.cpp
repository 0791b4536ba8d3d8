// Reading, compiling, linking; a driver's complaint with the file's name before the line.
#include "view/shaders.h"

#include <array>
#include <fstream>
#include <iterator>
#include <span>

#include <fmt/format.h>

#include "base/embedded.h"
#include "base/log.h"
#include "base/text.h"

namespace limber {

/// The files of shaders/, which the build puts inside the program.
std::span<const EmbeddedFile> shader_files();

namespace {

constexpr const char* kCommon = "common.glsl";
constexpr int kOwnLines = 10000;  // before a file's own first line

struct ProgramFiles {
  const char* name;
  const char* vertex;
  const char* fragment;
  const char* defines = "";
  bool GlApiInfo::*unless = nullptr;  // replaces this feature of OpenGL
};
const std::array<ProgramFiles, 8> kPrograms = {
    {{"shape", "shape.vert", "shape.frag"},
     {"depth", "shape.vert", "depth.frag"},
     {"floor", "floor.vert", "floor.frag"},
     {"sky", "sky.vert", "sky.frag"},
     {"overlay", "overlay.vert", "overlay.frag"},
     {"mirrored", "shape.vert", "shape.frag", "#define MIRRORED\n", &GlApiInfo::clip_distance},
     {"ground", "shape.vert", "ground.frag", "#define GROUND\n", &GlApiInfo::depth_clamp},
     {"encode", "encode.vert", "encode.frag", "", &GlApiInfo::srgb_switch}}};

// in front of every shader: the version, and what that leaves open
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

std::string Shaders::text_of(const std::string& file, bool inside) const {
  if (!inside) {
    std::ifstream in(folder_ + "/" + file, std::ios::binary);
    if (in) return {std::istreambuf_iterator<char>(in), {}};
  }
  const EmbeddedFile* const found = find_embedded(shader_files(), file);
  return found == nullptr ? std::string() : std::string(found->text);
}

// drivers say "0:12(5): error: …" or "0(12) : error …"; lines of the file itself count from kOwnLines
std::string Shaders::placed(const std::string& log, const std::string& file, bool inside) const {
  std::string out;
  for (std::string_view line : split(log, '\n')) {
    if (line.empty()) continue;
    if (!out.empty()) out += '\n';
    const std::size_t end = line.find_first_not_of("0123456789", 2);
    const bool counted = line.size() > 2 && line[0] == '0' && (line[1] == ':' || line[1] == '(') && end > 2;
    const auto number = counted ? parse_number(line.substr(2, end - 2)) : std::nullopt;
    if (number) {
      const bool own = *number > kOwnLines;
      out += fmt::format("{}/{}:{}{}", inside ? "shaders" : folder_, own ? file : kCommon,
                         *number - (own ? kOwnLines : 0), end < line.size() ? line.substr(end) : "");
    } else {
      out += line;
    }
  }
  return printable(shortened(out, 1000));
}

Result<GLuint> Shaders::compile(GLenum kind, const std::string& file, const std::string& defines, bool inside) const {
  const int first = 1 - api_.line_offset;
  const std::string text = fmt::format("{}{}{}#line {}\n{}\n#line {}\n{}", header(api_), defines_, defines, first,
                                       text_of(kCommon, inside), kOwnLines + first, text_of(file, inside));
  const char* const source = text.c_str();
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint good = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good == GL_TRUE) return shader;
  const std::string log = log_of(shader, glGetShaderInfoLog);
  glDeleteShader(shader);
  return Error{placed(log, file, inside)};
}

Result<GlProgram> Shaders::build(const Made& wanted, bool inside) const {
  const Result<GLuint> vertex = compile(GL_VERTEX_SHADER, wanted.vertex, wanted.defines, inside);
  if (!vertex) return Error{vertex.error()};
  const Result<GLuint> fragment = compile(GL_FRAGMENT_SHADER, wanted.fragment, wanted.defines, inside);
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
  GLint good = GL_FALSE;
  glGetProgramiv(*program, GL_LINK_STATUS, &good);
  if (good != GL_TRUE) {
    return Error{fmt::format("shaders {} and {} don't fit: {}", wanted.vertex, wanted.fragment,
                             placed(log_of(*program, glGetProgramInfoLog), wanted.fragment, inside))};
  }
  if (const GLuint block = glGetUniformBlockIndex(*program, "Frame"); block != GL_INVALID_INDEX)
    glUniformBlockBinding(*program, block, 0);
  glUseProgram(*program);
  constexpr std::array<const char*, 2> kTextures = {"lamp_depth", "ground_depth"};
  for (std::size_t i = 0; i < kTextures.size(); i++)
    glUniform1i(glGetUniformLocation(*program, kTextures[i]), static_cast<GLint>(i));
  return program;
}

void Shaders::complain(const std::string& text) {
  if (fault_ == text) return;
  fault_ = text;
  if (!text.empty()) log_error("{}\nthe picture is drawn as before", text);
}

Result<void> Shaders::start() {
  std::string fault;
  for (const ProgramFiles& files : kPrograms) {
    if (files.unless != nullptr && api_.*files.unless) continue;
    Made& made = made_[files.name];
    made = {files.vertex, files.fragment, files.defines, {}};
    Result<GlProgram> program = build(made, folder_.empty());
    if (!program && !folder_.empty()) {
      fault = program.error();
      program = build(made, true);
    }
    if (!program) return Error{fmt::format("OpenGL refuses the program's own shaders: {}", program.error())};
    made.program = std::move(*program);
  }
  if (!folder_.empty()) {
    for (const EmbeddedFile& file : shader_files())
      stamps_[std::string(file.name)] = FileStamp(folder_ + "/" + std::string(file.name));
  }
  complain(fault);
  return {};
}

bool Shaders::renew() {
  bool changed = false;
  for (auto& [file, stamp] : stamps_) {
    const std::string path = folder_ + "/" + file;
    if (stamp.holds(path)) continue;
    stamp = FileStamp(path);
    changed = true;
  }
  if (!changed) return false;
  bool made_one = false;
  std::string fault;
  for (auto& [name, made] : made_) {
    Result<GlProgram> program = build(made, false);
    if (!program) {
      fault = program.error();
      continue;
    }
    made.program = std::move(*program);
    made_one = true;
  }
  if (fault.empty()) log_info("shaders: read anew");
  complain(fault);
  return made_one;
}

GLuint Shaders::program(std::string_view name) const { return *made_.find(name)->second.program; }

GLint Shaders::uniform(std::string_view name, const char* uniform) const {
  return glGetUniformLocation(program(name), uniform);
}

}  // namespace limber
