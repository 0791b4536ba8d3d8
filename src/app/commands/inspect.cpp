// Prints the contents of a URDF or MJCF file in file order, and every problem with its line and fix.
#include "app/commands/commands.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/exit_code.h"
#include "app/show/play.h"
#include "app/viewer/model_file.h"
#include "base/log/output.h"
#include "base/plural.h"
#include "base/text.h"
#include "model/import.h"
#include "model/mesh/surface.h"

namespace limber::app {

namespace {

using Json = nlohmann::ordered_json;

const char* severity_name(model::Severity severity) {
  switch (severity) {
    case model::Severity::note:
      return "note";
    case model::Severity::warning:
      return "warning";
    case model::Severity::error:
      return "error";
  }
  return "";
}

Json json_of(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }
Json json_of(const Pose& p) {
  const Quat& q = p.rotation;
  return {{"position", json_of(p.position)}, {"rotation", Json::array({q.x, q.y, q.z, q.w})}};
}

Json json_of(const model::FileLink& link) {
  const Mat3& t = link.tensor;
  return {{"name", link.name},
          {"mass", link.mass},
          {"com", json_of(link.center)},
          {"inertia", Json::array({t[0][0], t[0][1], t[0][2], t[1][1], t[1][2], t[2][2]})},
          {"collisions", link.collisions},
          {"visuals", link.visuals},
          {"home", json_of(link.home)},
          {"start", json_of(link.start)}};
}

Json json_of(const model::FileJoint& joint) {
  Json j = {{"name", joint.name},
            {"type", joint.type},
            {"parent", joint.parent},
            {"child", joint.child},
            {"axis", json_of(joint.axis)},
            {"lower", joint.free ? Json() : Json(joint.lower)},
            {"upper", joint.free ? Json() : Json(joint.upper)},
            {"effort", joint.effort},
            {"velocity", joint.velocity},
            {"free", joint.free}};
  if (!joint.mimic.empty()) {
    j["mimic"] = {{"joint", joint.mimic}, {"multiplier", joint.mimic_multiplier}, {"offset", joint.mimic_offset}};
  }
  return j;
}

const char* kind_name(model::ShapeKind kind) {
  switch (kind) {
    case model::ShapeKind::plane:
      return "plane";
    case model::ShapeKind::sphere:
      return "sphere";
    case model::ShapeKind::box:
      return "box";
    case model::ShapeKind::cylinder:
      return "cylinder";
    case model::ShapeKind::capsule:
      return "capsule";
    case model::ShapeKind::cone:
      return "cone";
    case model::ShapeKind::mesh:
      return "hull";
    case model::ShapeKind::compound:
      return "compound";
    case model::ShapeKind::ellipsoid:
      return "ellipsoid";
  }
  return "";
}

std::string vec_text(const Vec3& v) { return fmt::format("{:9.4f} {:9.4f} {:9.4f}", v.x, v.y, v.z); }

void add_links(const model::BodyModel& model, std::string& out) {
  std::size_t width = 4;
  for (const model::FileLink& l : model.file_links) width = std::max(width, printable(l.name).size());
  out +=
      fmt::format("\n{:<{}}  {:>10}  {:>4}  {:>4}  {}\n", "link", width, "mass kg", "coll", "vis", "home position m");
  for (const model::FileLink& l : model.file_links) {
    out += fmt::format("{:<{}}  {:>10.6g}  {:>4}  {:>4}  {}\n", printable(l.name), width, l.mass, l.collisions,
                       l.visuals, vec_text(l.home.position));
  }
}

void add_joints(const model::BodyModel& model, std::string& out) {
  std::size_t width = 5;
  for (const model::FileJoint& j : model.file_joints) width = std::max(width, printable(j.name).size());
  out += fmt::format("\n{:<{}}  {:<10}  {:<26}  {:<22}  {:>8}  {}\n", "joint", width, "type", "axis", "limits",
                     "effort", "parent -> child");
  for (const model::FileJoint& j : model.file_joints) {
    const std::string limits = j.free ? "free" : fmt::format("{:.5g} .. {:.5g}", j.lower, j.upper);
    out += fmt::format("{:<{}}  {:<10}  {:<26}  {:<22}  {:>8.5g}  {} -> {}\n", printable(j.name), width, j.type,
                       fmt::format("{:.5g} {:.5g} {:.5g}", j.axis.x, j.axis.y, j.axis.z), limits, j.effort,
                       printable(j.parent), printable(j.child));
  }
}

void add_mimics(const model::BodyModel& model, std::string& out) {
  bool first = true;
  for (const model::FileJoint& j : model.file_joints) {
    if (j.mimic.empty()) continue;
    if (std::exchange(first, false)) out += "\nmimic\n";
    out += fmt::format("  {} = {:.6g} * {} {} {:.6g}\n", printable(j.name), j.mimic_multiplier, printable(j.mimic),
                       j.mimic_offset < 0 ? '-' : '+', std::abs(j.mimic_offset));
  }
}

void add_loops(const model::BodyModel& model, std::string& out) {
  if (!model.loops.empty()) out += "\nloops\n";
  for (const model::JointModel& loop : model.loops) {
    out += fmt::format("  {}: {}, {} -> {}\n", printable(loop.name), model::joint_type_name(loop.type),
                       printable(model.links[static_cast<std::size_t>(loop.parent)].name),
                       printable(model.links[static_cast<std::size_t>(loop.child)].name));
  }
}

std::vector<std::string> tendon_links(const model::BodyModel& model, const model::TendonModel& tendon) {
  std::vector<std::string> links;
  for (const model::TendonModel::Point& point : tendon.points)
    links.push_back(model.links[static_cast<std::size_t>(point.link)].name);
  return links;
}

void add_tendons(const model::BodyModel& model, std::string& out) {
  if (!model.tendons.empty()) out += "\ntendons\n";
  for (const model::TendonModel& tendon : model.tendons) {
    std::vector<std::string> links = tendon_links(model, tendon);
    for (std::string& name : links) name = printable(name);
    out += fmt::format("  {}: through {}, {:.6g} N/m, {:.6g} N·s/m, rest length {}{}\n", printable(tendon.name),
                       fmt::join(links, ", "), tendon.stiffness, tendon.damping,
                       tendon.rest ? fmt::format("{:.6g} m", *tendon.rest) : "that of the start",
                       tendon.pushes ? ", also pushes" : "");
  }
}

Json tendons_json(const model::BodyModel& model) {
  Json tendons = Json::array();
  for (const model::TendonModel& tendon : model.tendons) {
    tendons.push_back({{"name", tendon.name},
                       {"links", tendon_links(model, tendon)},
                       {"stiffness", tendon.stiffness},
                       {"damping", tendon.damping},
                       {"rest", tendon.rest ? Json(*tendon.rest) : Json()},
                       {"pushes", tendon.pushes}});
  }
  return tendons;
}

// the volume of a mesh's hulls, relative to its own; 0: it isn't closed
double volume_ratio(const model::MeshModel& mesh) {
  return mesh.closed && mesh.unit_inertial.mass > 0 ? mesh.hull_volume / mesh.unit_inertial.mass : 0;
}

// "sphere", "hull of 8 points (1.02 times the mesh's volume, farthest vertex 0 m outside)",
// "8 hulls (3 boxes, 5 hulls; …)"
std::string collision_text(const model::PlacedShape& placed) {
  if (placed.shape.surface != nullptr)
    return fmt::format("surface of {}", counted(placed.shape.surface->size(), "triangle"));
  const model::MeshModel* const mesh = placed.shape.mesh.get();
  if (placed.shape.kind != model::ShapeKind::mesh || mesh == nullptr) return kind_name(placed.shape.kind);
  const double ratio = volume_ratio(*mesh);
  const std::string quality =
      fmt::format("{}farthest vertex {:.2g} m outside",
                  ratio > 0 ? fmt::format("{:.3g} times the mesh's volume, ", ratio) : "", mesh->hull_error);
  if (mesh->pieces.empty()) return fmt::format("hull of {} ({})", counted(mesh->hull.size(), "point"), quality);
  std::map<std::string, std::size_t> kinds;
  for (const model::PlacedShape& piece : mesh->pieces) kinds[kind_name(piece.shape.kind)]++;
  std::string list;
  for (const auto& [kind, count] : kinds)
    list += fmt::format("{}{}", list.empty() ? "" : ", ",
                        kind == "box" ? counted(count, "box", "boxes") : counted(count, kind));
  return fmt::format("{} convex pieces ({}; {})", mesh->pieces.size(), list, quality);
}

void add_body(const model::BodyModel& model, std::string& out) {
  out += "\nresulting body (mass 0: fixed to the world)\n";
  for (const model::LinkModel& link : model.links) {
    out += fmt::format("  {}: {:.6g} kg", printable(link.name), link.inertial.mass);
    for (const model::PlacedShape& s : link.collisions) out += ", " + collision_text(s);
    if (!link.self_collision) out += ", does not collide with its own body (selfCollide)";
    out += '\n';
  }
  for (const model::MergedLink& m : model.merged) {
    out += fmt::format("  {}: {} {}\n", printable(m.name), m.site ? "site of" : "merged into",
                       printable(model.links[static_cast<std::size_t>(m.link)].name));
  }
}

// A color of visuals, with the links that have it.
struct UsedColor {
  Vec3 color{0};
  double alpha = 1;
  std::vector<std::string> links;
};

std::vector<UsedColor> used_colors(const model::BodyModel& model) {
  std::vector<UsedColor> colors;
  for (const model::LinkModel& link : model.links) {
    for (const model::PlacedShape& visual : link.visuals) {
      if (!visual.color) continue;
      const auto same = [&](const UsedColor& c) { return c.color == *visual.color && c.alpha == visual.alpha; };
      auto found = std::ranges::find_if(colors, same);
      if (found == colors.end()) found = colors.insert(colors.end(), {*visual.color, visual.alpha, {}});
      if (found->links.empty() || found->links.back() != link.name) found->links.push_back(link.name);
    }
  }
  return colors;
}

void add_colors(const model::BodyModel& model, std::string& out) {
  const std::vector<UsedColor> colors = used_colors(model);
  if (!colors.empty()) out += "\ncolors of visuals (red green blue alpha)\n";
  for (const UsedColor& c : colors) {
    out += fmt::format("  {:.3g} {:.3g} {:.3g} {:.3g}: {}\n", c.color.x, c.color.y, c.color.z, c.alpha,
                       printable(fmt::format("{}", fmt::join(c.links, ", "))));
  }
}

// the links of the resulting body that touch nothing
std::vector<std::string> links_without_collision(const model::BodyModel& model) {
  std::vector<std::string> names;
  for (const model::LinkModel& link : model.links) {
    if (link.collisions.empty()) names.push_back(link.name);
  }
  return names;
}

void add_links_without_collision(const model::BodyModel& model, std::string& out) {
  const std::vector<std::string> names = links_without_collision(model);
  if (names.empty()) return;
  out += fmt::format("\nlinks without collision shapes (they touch nothing)\n  {}\n",
                     printable(fmt::format("{}", fmt::join(names, ", "))));
}

Json json_of(const UsedColor& c) {
  return {{"color", Json::array({c.color.x, c.color.y, c.color.z, c.alpha})}, {"links", c.links}};
}

const std::string& link_name(const model::BodyModel& model, int link) {
  return model.links[static_cast<std::size_t>(link)].name;
}

void add_overlaps(const model::BodyModel& model, std::string& out) {
  if (!model.exclusions.empty()) out += "\npairs excluded from collision by the file\n";
  for (const auto& [a, b] : model.exclusions) {
    out += fmt::format("  {} and {}\n", printable(link_name(model, a)), printable(link_name(model, b)));
  }
  if (model.overlaps.empty()) return;
  out += "\npairs excluded from collision (they overlap with all joints at 0)\n";
  for (const model::Overlap& overlap : model.overlaps) {
    out += fmt::format("  {} and {}: {:.3g} mm\n", printable(link_name(model, overlap.a)),
                       printable(link_name(model, overlap.b)), overlap.depth * 1000);
  }
}

// plays the model until its first image
int render_model(const InspectCommand& command, const std::string& file) {
  PlayOptions play;
  play.scene = file;
  play.package_paths = command.package_paths;
  play.root = command.root;
  play.display.screenshot = command.screenshot;
  play.display.size = command.size;
  return play_command(play);
}

// the meshes that collide as hulls, with the number of their hulls
Json hulls_json(const model::BodyModel& model) {
  Json hulls = Json::array();
  for (const model::LinkModel& link : model.links) {
    for (const model::PlacedShape& placed : link.collisions) {
      const model::MeshModel* const mesh = placed.shape.mesh.get();
      if (placed.shape.kind != model::ShapeKind::mesh || mesh == nullptr || placed.shape.surface != nullptr) continue;
      const double ratio = volume_ratio(*mesh);
      hulls.push_back({{"link", link.name},
                       {"mesh", mesh->name},
                       {"count", std::max<std::size_t>(1, mesh->pieces.size())},
                       {"volume_ratio", ratio > 0 ? Json(ratio) : Json()},
                       {"error", mesh->hull_error}});
    }
  }
  return hulls;
}

// the meshes of fixed links that collide as they are
Json surfaces_json(const model::BodyModel& model) {
  Json surfaces = Json::array();
  for (const model::LinkModel& link : model.links) {
    for (const model::PlacedShape& placed : link.collisions) {
      if (placed.shape.surface == nullptr) continue;
      surfaces.push_back({{"link", link.name}, {"triangles", placed.shape.surface->size()}});
    }
  }
  return surfaces;
}

}  // namespace

std::string inspect_json(const model::BodyModel& model) {
  Json links = Json::array(), joints = Json::array(), problems = Json::array();
  for (const model::FileLink& link : model.file_links) links.push_back(json_of(link));
  for (const model::FileJoint& joint : model.file_joints) joints.push_back(json_of(joint));
  for (const model::Problem& p : model.problems) {
    problems.push_back({{"line", p.line}, {"severity", severity_name(p.severity)}, {"text", p.text}, {"cure", p.fix}});
  }
  Json loops = Json::array();
  for (const model::JointModel& loop : model.loops) {
    loops.push_back({{"name", loop.name},
                     {"type", model::joint_type_name(loop.type)},
                     {"parent", link_name(model, loop.parent)},
                     {"child", link_name(model, loop.child)}});
  }
  Json pairs = Json::array(), no_self_collision = Json::array();
  for (const model::Overlap& overlap : model.overlaps) {
    pairs.push_back({{"a", link_name(model, overlap.a)}, {"b", link_name(model, overlap.b)}, {"depth", overlap.depth}});
  }
  for (const auto& [a, b] : model.exclusions)
    pairs.push_back({{"a", link_name(model, a)}, {"b", link_name(model, b)}, {"depth", nullptr}});
  for (const model::LinkModel& link : model.links) {
    if (!link.self_collision) no_self_collision.push_back(link.name);
  }
  Json materials = Json::array();
  for (const UsedColor& color : used_colors(model)) materials.push_back(json_of(color));
  const Json all{{"robot", model.name},
                 {"links", links},
                 {"joints", joints},
                 {"loops", loops},
                 {"tendons", tendons_json(model)},
                 {"excluded_pairs", pairs},
                 {"no_self_collision", no_self_collision},
                 {"no_collision", links_without_collision(model)},
                 {"hulls", hulls_json(model)},
                 {"surfaces", surfaces_json(model)},
                 {"materials", materials},
                 {"problems", problems}};
  return all.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string inspect_table(const model::BodyModel& model) {
  double mass = 0;
  for (const model::FileLink& link : model.file_links) mass += link.mass;
  std::string out =
      fmt::format("{}: {}, {}, {:.6g} kg\n", printable(model.name), counted(model.file_links.size(), "link"),
                  counted(model.file_joints.size(), "joint"), mass);
  add_links(model, out);
  if (!model.file_joints.empty()) add_joints(model, out);
  add_mimics(model, out);
  add_loops(model, out);
  add_tendons(model, out);
  add_body(model, out);
  add_colors(model, out);
  add_links_without_collision(model, out);
  add_overlaps(model, out);
  out += model.problems.empty() ? "\nno problems\n" : "\n";
  for (const model::Problem& p : model.problems) {
    out += fmt::format("{}:{}: {}: {}. {}\n", printable(model.file), p.line, severity_name(p.severity), p.text, p.fix);
  }
  return out;
}

int inspect_command(const InspectCommand& command) {
  model::ImportOptions options;
  options.package_paths = command.package_paths;
  options.root = command.root;
  std::error_code error;
  // only a folder is searched: the errors of a file are those of its reader
  const bool folder = std::filesystem::is_directory(command.file, error);
  const Result<std::string> file = folder ? find_model(command.file) : Result<std::string>(command.file);
  if (!file) return fail(kInputError, file.error());
  const Result<std::shared_ptr<const model::BodyModel>> model = model::import_model(*file, options);
  if (!model) {
    write_line(OutputTo::error, model.error());
    return kInputError;
  }
  const std::string text = command.json ? inspect_json(**model) : inspect_table(**model);
  write_result(text);
  return command.screenshot.empty() ? kSuccess : render_model(command, *file);
}

}  // namespace limber::app
