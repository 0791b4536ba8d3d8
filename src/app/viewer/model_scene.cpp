// Writes scenes of models.
#include "app/viewer/model_scene.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "app/paths.h"
#include "base/hash.h"
#include "base/log/log.h"
#include "base/lua_text.h"
#include "base/plural.h"
#include "base/system/file.h"
#include "base/system/process.h"
#include "base/text.h"
#include "model/import.h"
#include "sim/shapes/bounds.h"

namespace limber::app {

namespace {

namespace fs = std::filesystem;

constexpr double kSmall = 0.25;    // below this size the camera comes nearer than its default allows, m
constexpr double kLarge = 30;      // above this size the camera sees farther, m
constexpr double kSlowSize = 0.1;  // below this size motion is so fast that a tick needs more substeps, m
constexpr int kSubsteps = 4;       // the default
constexpr int kMaxSubsteps = 40;
constexpr std::size_t kMaxName = 64;  // of the file of a scene

// text on one line, for comments
std::string one_line(std::string_view text) {
  std::string line;
  for (const char c : printable(text)) line += c == '\n' || c == '\t' ? std::string(" ") : std::string(1, c);
  return line;
}

// rounded to one digit, down
double rounded(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)));
  return std::floor(value / unit + 1e-9) * unit;
}

// settings for models that are much smaller or larger than a person
std::string size_lines(double size) {
  std::string text;
  if (size <= 0) return text;
  if (size < kSmall) text += fmt::format("visuals.camera.near = {:.1g}\n", rounded(size / 20));
  if (size > kLarge) text += fmt::format("visuals.camera.far = {:.0f}\n", rounded(size * 20));
  if (size < kSlowSize)
    text += fmt::format("sim.substeps = {}\n",
                        std::min(kMaxSubsteps, static_cast<int>(std::ceil(kSubsteps * std::sqrt(kSlowSize / size)))));
  if (text.empty()) return text;
  return fmt::format(
      "\n-- The model has a size of {:.2g} m. The camera, and the time step of small models, are adapted to it.\n{}",
      size, text);
}

std::string options_text(const ModelScene& scene, const model::BodyModel& body) {
  std::string options;
  const auto add = [&](const std::string& option) { options += (options.empty() ? " " : ", ") + option; };
  if (engine::needs_servos(body)) add("motors = \"servo\"");
  std::string folders;
  for (const std::string& folder : scene.package_paths) folders += (folders.empty() ? " " : ", ") + lua_string(folder);
  if (!scene.root.empty()) add("root = " + lua_string(scene.root));
  if (!folders.empty()) add(fmt::format("package_path = {{{} }}", folders));
  return options.empty() ? "" : fmt::format(", {{{} }}", options);
}

// the floor, below a fixed model or at height 0 below one that is put on it
std::string floor_lines(const model::BodyModel& body, const sim::Bounds& bounds) {
  const std::string name = lua_string(body.name == "floor" ? "ground" : "floor");
  const auto floor = [&](std::string_view options) {
    return fmt::format("sim:add_body({0}):add_part({0}, sim:add_plane_shape({0}), {{ {1} }})\n", name, options);
  };
  if (bounds.empty()) return "\n" + floor("friction = 1");
  if (body.links.front().inertial.mass == 0) {
    return "\n-- It is fixed to the world, where its file places it. The floor is below its lowest point.\n"
           "local low = robot:bounds()\n" +
           floor("friction = 1, position = vec3(0, 0, low.z)");
  }
  return "\n-- It can move freely. Its lowest point is put on the floor.\n"
         "robot.position = robot.position - vec3(0, 0, robot:bounds().z)\n" +
         floor("friction = 1");
}

bool has_target_number(const model::JointModel& joint, bool all) {
  return joint.takes_servo() && joint.type != model::JointType::spherical && (all || joint.driven);
}

// the motors with the ranges of their joints, as comments
std::string motor_lines(const model::BodyModel& body) {
  const bool all = engine::needs_servos(body);
  std::string lines;
  const model::JointModel* first = nullptr;
  for (const model::JointModel& joint : body.joints) {
    if (!has_target_number(joint, all)) continue;
    if (first == nullptr) first = &joint;
    const std::string range = joint.limited ? fmt::format("{:.4g} .. {:.4g}", joint.lower, joint.upper) : "no limits,";
    lines += fmt::format("-- robot:motor({}).target = {:.4g} -- {} {}\n", lua_string(joint.name), joint.start, range,
                         joint.type == model::JointType::prismatic ? "m" : "rad");
  }
  if (first == nullptr) return {};
  std::string text =
      "\n-- Its motors hold their positions. Remove the dashes of a line to begin with another one; its range "
      "follows.\n" +
      lines;
  const double middle = first->limited ? (first->lower + first->upper) / 2 : first->start;
  const double reach = first->limited ? std::min(0.5, (first->upper - first->lower) / 4) : 0.5;
  const std::string center = middle == 0 ? std::string() : fmt::format("{:.4g} + ", middle);
  text += fmt::format(
      "\n-- Motion, for example:\n"
      "-- sim:on_step(function() robot:motor({}).target = {}{:.4g} * math.sin(sim.time) end)\n",
      lua_string(first->name), center, reach);
  return text;
}

Result<std::shared_ptr<const model::BodyModel>> import(const ModelScene& scene) {
  model::ImportOptions options;
  options.package_paths = scene.package_paths;
  options.root = scene.root;
  return model::import_model(scene.model, options);
}

// letters, digits, - and _ of the file's name
std::string plain_name(const std::string& model) {
  std::string name;
  for (const char c : fs::path(model).stem().string().substr(0, kMaxName)) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
    name += plain ? c : '_';
  }
  return name.empty() ? "model" : name;
}

// A new temporary folder; empty if none can be created.
fs::path temporary_folder() {
  std::error_code error;
  const fs::path parent = fs::temp_directory_path(error);
  for (int i = 0; i < 100 && !error; i++) {
    fs::path folder = parent / fmt::format("limber-models-{}-{}", system::process_id(), i);
    if (fs::create_directory(folder, error)) return folder;
  }
  return {};
}

// writes a temporary file and renames it, so that a program that plays the old file never reads a part of the new one
Result<void> replace_atomically(const std::string& file, const std::string& text, const std::string& shown) {
  const std::string temporary = fmt::format("{}.{}.tmp", file, system::process_id());
  std::error_code error;
  const Result<void> written = system::replace_file(temporary, text, 0644);
  if (written) fs::rename(temporary, file, error);
  if (written && !error) return {};
  (void)system::remove_file(temporary);
  return Error{fmt::format("{}: {}", printable(shown), written ? error.message() : written.error())};
}

// writes the file unless it has this text
Result<void> update_file(const fs::path& file, const std::string& text) {
  const Result<std::string> present = system::read_file(file.string(), text.size() + 1);
  if (present && *present == text) return {};
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (error) return Error{fmt::format("{}: {}", printable(file.string()), error.message())};
  return replace_atomically(file.string(), text, file.string());
}

}  // namespace

std::string model_scene_text(const ModelScene& scene, const std::string& scene_name, const std::string& path,
                             const model::BodyModel& body) {
  const sim::Bounds bounds = sim::bounds_of(body);
  const Vec3 size = bounds.size();
  std::string text = fmt::format(
      "-- {}: {} with {}. Limber has written this scene; play it with\n--\n--     limber {}\n--\n"
      "-- Units are meters, kilograms, seconds and radians. Z is up.\n",
      one_line(body.name), counted(body.links.size(), "part"), counted(body.joints.size(), "joint"),
      one_line(shell_word(scene_name)));
  text += size_lines(std::max({size.x, size.y, size.z}));
  text += fmt::format("\nlocal robot = sim:load_urdf({}{})\n", lua_string(path), options_text(scene, body));
  text += floor_lines(body, bounds);
  text += motor_lines(body);
  if (!scene.added.empty()) text += "\n-- models that were added\n";
  for (const engine::AddedModel& added : scene.added) text += engine::lua_line(added, added.path);
  return text;
}

std::string model_path_in_scene(const std::string& model, const std::string& scene) {
  const fs::path folder = fs::path(scene).parent_path();
  std::vector<fs::path> bases{folder};
  if (folder.filename() == "scripts") bases.push_back(folder.parent_path());
  for (const fs::path& base : bases) {
    const fs::path relative = fs::path(model).lexically_relative(base);
    if (!relative.empty() && *relative.begin() != ".." && *relative.begin() != ".") return relative.string();
  }
  return model;
}

Result<void> save_model_scene(const ModelScene& scene, const std::string& file, bool overwrite) {
  const std::string target = absolute_path(file);
  const auto body = import(scene);
  if (!body) return Error{body.error()};
  ModelScene saved = scene;
  for (engine::AddedModel& added : saved.added) added.path = model_path_in_scene(added.path, target);
  const std::string text =
      model_scene_text(saved, fs::path(file).filename().string(), model_path_in_scene(scene.model, target), **body);
  if (overwrite) return replace_atomically(target, text, file);
  const system::Descriptor out = system::open_file(target, system::OpenMode::create_new, 0666);
  if (!out.is_open() && errno == EEXIST)
    return Error{fmt::format("{} already exists and is not overwritten; choose another name, or add --overwrite",
                             printable(file))};
  if (!out.is_open() || !system::write_all(out.fd(), text))
    return Error{fmt::format("{}: {}", printable(file), system::error_reason())};
  return {};
}

Result<std::string> write_model_scene(const ModelScene& scene) {
  const auto body = import(scene);
  if (!body) return Error{body.error()};
  const std::string text = model_scene_text(scene, scene.model, scene.model, **body);
  const std::string name = plain_name(scene.model);
  // scripts/ makes the folder above it that of the show, which gets the takes
  const fs::path file =
      fs::path(fmt::format("{}-{:08x}", name, hash_bytes(scene.root, hash_bytes(scene.model)) >> 32u)) / "scripts" /
      (name + ".lua");
  std::string reason = "there is no home folder";
  if (const std::string state = state_dir(); !state.empty()) {
    const fs::path kept = fs::path(state) / "models" / file;
    const Result<void> written = update_file(kept, text);
    if (written) return kept.string();
    reason = written.error();
  }
  const fs::path folder = temporary_folder();
  if (folder.empty())
    return Error{fmt::format(
        "no folder for the scene of the model: {}. Set HOME or TMPDIR to a folder that is writable", reason)};
  log_warning("presets and takes of this model are in {}, because {}", printable(folder.string()), reason);
  if (const Result<void> written = update_file(folder / file, text); !written) return Error{written.error()};
  return (folder / file).string();
}

}  // namespace limber::app
