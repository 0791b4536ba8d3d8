// Settings of the compiler, bodies, sites and inertials.
#include "model/mjcf/file_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/text.h"
#include "model/xml_numbers.h"

namespace limber::model {

namespace {

constexpr double kMaxMass = 1e7;            // kg
constexpr double kDefaultSiteSize = 0.005;  // m

constexpr std::array<std::string_view, 18> kSections{
    "compiler",  "option",  "size",     "visual", "statistic", "default", "custom",   "extension",  "asset",
    "worldbody", "contact", "equality", "tendon", "actuator",  "sensor",  "keyframe", "deformable", "model"};

bool is_euler_order(std::string_view text) {
  return text.size() == 3 && text.find_first_not_of("xyzXYZ") == std::string_view::npos;
}

}  // namespace

Result<MjcfFile> MjcfFileReader::run(const std::string& fallback_name) {
  const std::string* const written = document_.root.attribute("model");
  const bool usable = written != nullptr && !name_error(*written);
  file_.name = usable ? *written : name_error(fallback_name) ? "model" : fallback_name;
  for (const MjcfElement& e : document_.root.children) {
    if (std::find(kSections.begin(), kSections.end(), e.name) != kSections.end()) continue;
    reader_.unknown(e, fmt::format("<{}> ignored: MJCF has no such section", printable_excerpt(e.name)), kSections,
                    "Remove it.");
  }
  for_each_section("compiler", [&](const MjcfElement& e) { read_compiler(e); });
  reader_.read_defaults();
  for_each_section("asset", [&](const MjcfElement& e) { read_assets(e); });
  file_.bodies.emplace_back().name = "world";
  file_.bodies[0].line = reader_.line_of(document_.root);
  for_each_section("worldbody", [&](const MjcfElement& e) {
    file_.bodies[0].line = reader_.line_of(e);
    read_content(e, 0, reader_.class_of(e, 0, "childclass"), {});
  });
  if (file_.bodies.size() == 1 && file_.bodies[0].geoms.empty()) {
    return Error{fmt::format("{}: no body and no geom found. Write <worldbody> with at least one <body>.",
                             file_.bodies[0].line)};
  }
  index_names();
  for_each_section("contact", [&](const MjcfElement& e) { read_contacts(e); });
  for_each_section("tendon", [&](const MjcfElement& e) { read_tendons(e); });
  for_each_section("equality", [&](const MjcfElement& e) {
    for (const MjcfElement& child : e.children) read_equality(child);
  });
  for_each_section("actuator", [&](const MjcfElement& e) {
    for (const MjcfElement& child : e.children) read_actuator(child);
  });
  for_each_section("sensor", [&](const MjcfElement& e) { read_sensors(e); });
  for_each_section("keyframe", [&](const MjcfElement& e) { read_keyframes(e); });
  for (const MjcfElement& e : document_.root.children) report_section(e);
  return std::move(file_);
}

void MjcfFileReader::read_compiler(const MjcfElement& element) {
  MjcfCompiler& to = reader_.compiler;
  reader_.check_attributes(element);
  if (const std::string* angle = element.attribute("angle")) {
    to.degrees = *angle != "radian";
    if (*angle != "radian" && *angle != "degree") {
      reader_.error(element, fmt::format("<compiler>: angle '{}' is read as degree", printable_excerpt(*angle)),
                    "Write angle=\"degree\" or angle=\"radian\".");
    }
  }
  if (const std::string* order = element.attribute("eulerseq")) {
    if (is_euler_order(*order)) {
      to.euler_order = *order;
    } else {
      reader_.error(element,
                    fmt::format("<compiler>: eulerseq '{}' is not an order; ignored", printable_excerpt(*order)),
                    "Write three of x y z X Y Z, such as eulerseq=\"xyz\".");
    }
  }
  const std::string* const coordinate = element.attribute("coordinate");
  if (coordinate != nullptr) to.global = *coordinate == "global";
  for (const char* const attribute : {"assetdir", "meshdir"}) {
    if (const std::string* folder = element.attribute(attribute)) to.mesh_folder = *folder;
  }
  for (const char* const attribute : {"assetdir", "texturedir"}) {
    if (const std::string* folder = element.attribute(attribute)) to.texture_folder = *folder;
  }
  to.auto_limits = reader_.flag(element, 0, "autolimits").value_or(to.auto_limits);
  to.strip_path = reader_.flag(element, 0, "strippath").value_or(to.strip_path);
  read_mass_settings(element);
}

void MjcfFileReader::read_mass_settings(const MjcfElement& element) {
  MjcfCompiler& to = reader_.compiler;
  if (element.attribute("inertiafromgeom") != nullptr) {
    const std::optional<bool> from_geoms = reader_.flag(element, 0, "inertiafromgeom");
    to.inertia_from_geoms = !from_geoms   ? MjcfCompiler::FromGeoms::automatic
                            : *from_geoms ? MjcfCompiler::FromGeoms::yes
                                          : MjcfCompiler::FromGeoms::no;
  }
  if (const auto range = reader_.numbers(element, 0, "inertiagrouprange", 2, 2); !range.empty()) {
    to.first_group = range[0];
    to.last_group = range[1];
  }
  to.bound_mass = std::clamp(reader_.number(element, 0, "boundmass", to.bound_mass), 0.0, kMaxMass);
  to.bound_inertia = std::clamp(reader_.number(element, 0, "boundinertia", to.bound_inertia), 0.0, kMaxMass);
  to.balance_inertia = reader_.flag(element, 0, "balanceinertia").value_or(to.balance_inertia);
  to.total_mass = std::min(reader_.number(element, 0, "settotalmass", to.total_mass), kMaxMass);
}

void MjcfFileReader::read_body(const MjcfElement& element, int parent, MjcfClass inherited, const Pose& frame) {
  if (file_.bodies.size() >= kMaxMjcfBodies) {
    reader_.unsupported(element, fmt::format("more than {} bodies; the rest is ignored", kMaxMjcfBodies),
                        "Split the model.", Severity::error);
    return;
  }
  reader_.check_attributes(element);
  const int index = static_cast<int>(file_.bodies.size());
  MjcfBody& body = file_.bodies.emplace_back();
  body.line = reader_.line_of(element);
  body.parent = parent;
  body.name = reader_.name(element);
  body.pose = frame * reader_.pose(element, 0);
  body.start = body.pose;
  if (reader_.compiler.global && element.attribute("pos") == nullptr) {
    reader_.unsupported(element, "<body> without pos in global coordinates: its frame is at the world's origin",
                        "Write pos=\"x y z\".", Severity::warning);
  }
  if (const std::string* const mocap = element.attribute("mocap"); mocap != nullptr && *mocap == "true") {
    reader_.unsupported(element, "<body mocap='true'>: the body is fixed to the world", "Move it in the scene.");
  }
  read_content(element, index, reader_.class_of(element, inherited, "childclass"),
               reader_.compiler.global ? body.pose.inverse() * frame : Pose{});
}

void MjcfFileReader::read_content(const MjcfElement& element, int index, MjcfClass inherited, const Pose& frame) {
  bool has_inertial = false;
  for (const MjcfElement& e : element.children) {
    if (e.name == "body") {
      read_body(e, index, inherited, frame);
    } else if (e.name == "geom") {
      read_geom(e, body(index), inherited, frame);
    } else if (e.name == "site") {
      read_site(e, index, inherited, frame);
    } else if (e.name == "frame") {
      reader_.check_attributes(e);
      read_content(e, index, reader_.class_of(e, inherited, "childclass"), frame * reader_.pose(e, 0));
    } else if (index > 0 && (e.name == "joint" || e.name == "freejoint")) {
      read_joint(e, body(index), inherited, frame);
    } else if (index > 0 && e.name == "inertial" && !has_inertial) {
      has_inertial = true;
      read_inertial(e, body(index), frame);
    } else {
      report_unknown(e, element);
    }
  }
}

void MjcfFileReader::report_unknown(const MjcfElement& element, const MjcfElement& parent) {
  if (element.name == "camera" || element.name == "light") {
    reader_.unsupported(element, fmt::format("<{}> ignored: the scene sets the view", element.name),
                        "Set visuals.camera and visuals.look in the scene.");
    return;
  }
  constexpr std::array<std::string_view, 7> kKnown{"body", "geom", "site", "frame", "joint", "inertial", "freejoint"};
  reader_.unknown(element,
                  fmt::format("<{}> inside <{}> ignored: it is not supported", printable_excerpt(element.name),
                              printable_excerpt(parent.name)),
                  kKnown, "Load the file in MuJoCo and save it: it then has plain bodies.");
}

void MjcfFileReader::read_site(const MjcfElement& element, int index, MjcfClass inherited, const Pose& frame) {
  reader_.check_attributes(element);
  const std::string name = reader_.name(element);
  if (name.empty()) return;
  const MjcfClass cls = reader_.class_of(element, inherited);
  Pose pose = frame * reader_.pose(element, cls);
  if (const auto ends = reader_.numbers(element, cls, "fromto", 6, 6); !ends.empty())
    pose.position = frame * (0.5 * (Vec3(ends[0], ends[1], ends[2]) + Vec3(ends[3], ends[4], ends[5])));
  const std::vector<double> size = reader_.numbers(element, cls, "size", 1, 3);
  const double radius = size.empty() ? kDefaultSiteSize : *std::max_element(size.begin(), size.end());
  body(index).sites.push_back({name, pose, std::clamp(radius, 1e-6, 1e6)});
}

bool MjcfFileReader::read_tensor(const MjcfElement& element, UrdfInertial& out) {
  if (const auto full = reader_.numbers(element, 0, "fullinertia", 6, 6); !full.empty()) {
    out.tensor = Mat3(full[0], full[3], full[4], full[3], full[1], full[5], full[4], full[5], full[2]);
    return true;
  }
  const std::optional<Vec3> diagonal = reader_.vector(element, 0, "diaginertia");
  if (diagonal) out.tensor = Mat3(diagonal->x, 0, 0, 0, diagonal->y, 0, 0, 0, diagonal->z);
  return diagonal.has_value();
}

void MjcfFileReader::read_inertial(const MjcfElement& element, MjcfBody& body, const Pose& frame) {
  reader_.check_attributes(element);
  if (reader_.compiler.inertia_from_geoms == MjcfCompiler::FromGeoms::yes) return;
  UrdfInertial read;
  const std::vector<double> mass = reader_.numbers(element, 0, "mass", 1, 1);
  if (mass.empty() || mass[0] < 0 || mass[0] > kMaxMass) {
    reader_.error(element, "<inertial> has no valid mass; ignored, its geoms are used", "Write mass=\"…\" in kg.");
    return;
  }
  const Pose pose = frame * reader_.pose(element, 0);
  read.mass = mass[0];
  read.origin.xyz = pose.position;
  read.origin.quat = pose.rotation;
  read.has_tensor = read_tensor(element, read);
  if (!read.has_tensor && read.mass > 0) {
    reader_.warning(element, "<inertial> has no inertia; using the shape's",
                    "Write diaginertia=\"ixx iyy izz\" in kg·m².");
  }
  body.declared = read;
}

}  // namespace limber::model
