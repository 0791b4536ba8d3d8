// Validates the whole document: root, links, joints, materials, <gazebo> settings, and elements that are not used.
#include "model/urdf/check.h"

#include <array>
#include <map>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/plural.h"
#include "base/text.h"
#include "model/urdf/reader.h"
#include "model/xml_document.h"

namespace limber::model {

namespace {

using Element = tinyxml2::XMLElement;

constexpr std::size_t kMaxShownName = 40;

constexpr std::array<std::string_view, 17> kElements{
    "limber:loop", "link", "joint", "material", "inertial", "visual",   "collision", "origin", "parent",
    "child",       "axis", "limit", "dynamics", "mimic",    "geometry", "inertia",   "mass"};

class UrdfChecker {
 public:
  UrdfChecker(UrdfReader& reader, Problems& problems) : reader_(reader), problems_(problems) {}

  UrdfFile run(const Element& robot, const std::string& fallback_name) {
    read_root(robot, fallback_name);
    for (const Element* e = robot.FirstChildElement(); e; e = e->NextSiblingElement()) {
      const std::string_view kind = reader_.name_of(*e);
      if (kind == "link") {
        read_link(*e);
      } else if (kind == "joint") {
        read_joint(*e);
      } else if (kind == "material") {
        read_material(*e);
      } else if (kind == "limber:loop") {
        read_loop(*e, robot);
      } else {
        if (kind == "gazebo") read_gazebo(*e);
        ++unused_.try_emplace(std::string(kind), 0, e->GetLineNum()).first->second.first;
      }
    }
    report_stray_text(robot);
    resolve_colors();
    apply_self_collisions();
    report_unused();
    reader_.report_deferred();
    return std::move(file_);
  }

 private:
  struct SelfCollision {
    std::string link;
    bool all;
    bool enabled;
    int line;
  };

  void read_root(const Element& robot, const std::string& fallback_name) {
    const char* name = robot.Attribute("name");
    const bool usable = name && !name_error(name);
    file_.name = usable ? name : (name_error(fallback_name) ? "robot" : fallback_name);
    if (!usable) {
      problems_.warning(robot.GetLineNum(), fmt::format("<robot> has no usable name; called '{}'", file_.name),
                        "Write <robot name=\"…\">.");
    }
    reader_.check_attributes(robot, {"name", "version"});
    const std::string_view version = robot.Attribute("version") ? robot.Attribute("version") : "1.0";
    if (version != "1.0" && version != "1.1" && version != "1.2") {
      problems_.warning(robot.GetLineNum(), fmt::format("<robot version='{}'> is read as 1.0", printable(version)),
                        "Write version=\"1.0\", or remove it.");
    }
    if (robot.Name() != reader_.name_of(robot)) {
      problems_.warning(robot.GetLineNum(), "the root element has a namespace prefix, which URDF does not have",
                        "Write <robot …> without a prefix.");
    }
  }

  void check_osc_name(const Element& element, std::string_view kind, const std::string& name) {
    const bool needs_escaping = escape_name(name) != name || name.find_first_of("&<>\"'") != std::string::npos;
    if (!needs_escaping) return;
    problems_.note(element.GetLineNum(),
                   fmt::format("{} '{}': its name is hard to write in an OSC address", kind, printable(name)),
                   "Use letters, digits, '_', '-' and '.'.");
  }

  void read_link(const Element& element) {
    const char* name = element.Attribute("name");
    if (!name || !*name) {
      problems_.error(element.GetLineNum(), "a <link> has no name; ignored", "Write <link name=\"…\">.");
      return;
    }
    if (const std::optional<std::string> fault = name_error(name)) {
      problems_.error(element.GetLineNum(),
                      fmt::format("link '{}': its name can't be used: {}; ignored",
                                  printable(std::string_view(name).substr(0, kMaxShownName)), *fault),
                      "Give it a short, printable name.");
      return;
    }
    if (!link_names_.insert(name).second) {
      problems_.error(element.GetLineNum(),
                      fmt::format("link '{}' is declared twice; using the first", printable(name)),
                      "Give every link a name of its own.");
      return;
    }
    check_osc_name(element, "link", name);
    file_.links.push_back(reader_.link(element, name));
    count_unused(element, {"inertial", "visual", "collision"});
    for (const Element* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) {
      const std::string_view kind = reader_.name_of(*e);
      if (kind == "inertial") count_unused(*e, {"origin", "mass", "inertia"});
      if (kind == "visual" || kind == "collision") count_unused(*e, {"origin", "geometry", "material"});
    }
  }

  void read_joint(const Element& element) {
    const char* written = element.Attribute("name");
    std::string name = written ? written : "";
    const std::optional<std::string> fault = name_error(name);
    if (fault) {
      const Element* child = reader_.child(element, "child");
      const char* link = child ? child->Attribute("link") : nullptr;
      name = fmt::format("{}_joint", link && !name_error(link) ? link : "unnamed");
      problems_.warning(element.GetLineNum(),
                        written
                            ? fmt::format("a <joint>'s name can't be used: {}; called '{}'", *fault, printable(name))
                            : fmt::format("a <joint> has no name; called '{}'", printable(name)),
                        "Write <joint name=\"…\">, short and printable.");
    }
    std::optional<UrdfJoint> read = reader_.joint(element, name);
    count_unused(element, {"origin", "parent", "child", "axis", "limit", "dynamics", "mimic"});
    if (!read) return;
    check_osc_name(element, "joint", name);
    if (!joint_names_.insert(name).second) make_unique(*read);
    file_.joints.push_back(std::move(*read));
  }

  void read_loop(const Element& element, const Element& robot) {
    if (!robot.Attribute("xmlns:limber") && file_.loops.empty()) {
      problems_.note(element.GetLineNum(), "<limber:loop> is used without xmlns:limber; some readers reject the file",
                     "Write <robot … xmlns:limber=\"https://limber/urdf\">.");
    }
    std::optional<UrdfLoop> read = reader_.loop(element);
    count_unused(element, {"parent", "child", "axis", "limit", "dynamics"});
    if (read) file_.loops.push_back(std::move(*read));
  }

  // a second joint of the same name is renamed, not dropped, because its child links would be lost
  void make_unique(UrdfJoint& joint) {
    const std::string base = joint.name;
    int& next = next_suffix_.try_emplace(base, 2).first->second;
    do {
      joint.name = fmt::format("{}_{}", base, next++);
    } while (!joint_names_.insert(joint.name).second);
    problems_.error(
        joint.line,
        fmt::format("joint '{}' is declared twice; the second is called '{}'", printable(base), printable(joint.name)),
        "Give every joint a name of its own.");
  }

  void read_material(const Element& element) {
    const char* name = element.Attribute("name");
    if (!name || !*name) {
      problems_.warning(element.GetLineNum(), "a <material> has no name; ignored", "Write <material name=\"…\">.");
      return;
    }
    reader_.check_attributes(element, {"name"});
    const std::string owner = fmt::format("material '{}'", printable(name));
    UrdfMaterial material;
    declared_materials_.insert(name);
    if (!reader_.material(element, owner, material)) {
      problems_.warning(element.GetLineNum(), owner + " has no color and no texture; ignored",
                        "Write <color rgba=\"r g b a\"/> or <texture filename=\"…\"/> inside.");
    } else if (!materials_.try_emplace(name, material).second) {
      problems_.warning(element.GetLineNum(), owner + " is declared twice; using the first",
                        "Give every material a name of its own.");
    }
  }

  // materials defined inside a link can be referenced by other links, too
  void resolve_colors() {
    std::map<std::string, std::pair<int, int>> undefined;  // number of visuals, line of the first
    for (const UrdfLink& link : file_.links) {
      for (const UrdfShape& shape : link.visuals) {
        if (!shape.material.empty() && !shape.material_name.empty())
          materials_.try_emplace(shape.material_name, shape.material);
      }
    }
    for (UrdfLink& link : file_.links) {
      for (UrdfShape& shape : link.visuals) {
        if (!shape.material.empty() || shape.material_name.empty()) continue;
        const auto found = materials_.find(shape.material_name);
        if (found != materials_.end()) {
          shape.material = found->second;
        } else if (!declared_materials_.contains(shape.material_name)) {
          ++undefined.try_emplace(shape.material_name, 0, shape.line).first->second.first;
        }
      }
    }
    for (const auto& [name, usage] : undefined) {
      const std::string users = usage.first == 1 ? "a visual" : counted(usage.first, "visual");
      problems_.warning(usage.second,
                        fmt::format("material '{}' of {} is not defined; the default color is used",
                                    printable(std::string_view(name).substr(0, kMaxShownName)), users),
                        "Write <material name=\"…\"><color rgba=\"r g b a\"/></material> inside <robot>.");
    }
  }

  // <gazebo reference="link"><selfCollide>; without a reference it applies to all links
  void read_gazebo(const Element& element) {
    for (const char* const name : {"selfCollide", "self_collide"}) {
      const Element* const found = reader_.child(element, name);
      if (!found) continue;
      const std::string_view text = found->GetText() ? found->GetText() : "";
      const bool enabled = same_name(text, "true") || same_name(text, "1");
      if (!enabled && !same_name(text, "false") && !same_name(text, "0")) {
        problems_.warning(found->GetLineNum(),
                          fmt::format("<{}> is '{}'; ignored", name, printable(text.substr(0, kMaxShownName))),
                          "Write true or false.");
        continue;
      }
      const char* const link = element.Attribute("reference");
      self_collisions_.push_back({link ? link : "", link == nullptr, enabled, found->GetLineNum()});
    }
  }

  // settings for a single link override those for all links
  void apply_self_collisions() {
    for (const bool all : {true, false}) {
      for (const SelfCollision& setting : self_collisions_) {
        if (setting.all != all) continue;
        bool found = all;
        for (UrdfLink& link : file_.links) {
          if (!all && link.name != setting.link) continue;
          link.self_collision = setting.enabled;
          found = true;
        }
        if (found) continue;
        const std::vector<std::string> names(link_names_.begin(), link_names_.end());
        problems_.warning(setting.line,
                          fmt::format("<gazebo reference='{}'> with <selfCollide> names no link{}; ignored",
                                      printable(std::string_view(setting.link).substr(0, kMaxShownName)),
                                      name_hint(setting.link, names)),
                          "Name a link of this file.");
      }
    }
  }

  void report_stray_text(const Element& robot) {
    for (const tinyxml2::XMLNode* node = robot.FirstChild(); node; node = node->NextSibling()) {
      if (!node->ToText()) continue;
      problems_.warning(node->GetLineNum(), "text inside <robot> ignored", "Remove it.");
      return;
    }
  }

  void count_unused(const Element& element, std::initializer_list<std::string_view> used) {
    for (const Element* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) {
      const std::string_view kind = reader_.name_of(*e);
      bool known = false;
      for (const std::string_view name : used) known = known || name == kind;
      if (!known) ++unused_.try_emplace(std::string(kind), 0, e->GetLineNum()).first->second.first;
    }
  }

  void report_unused() {
    constexpr std::size_t kMaxKinds = 40;
    std::size_t kinds = 0;
    for (const auto& [kind, usage] : unused_) {
      if (++kinds > kMaxKinds) break;
      const bool xacro = kind.starts_with("xacro:");
      const std::string text =
          fmt::format("{} <{}> {} ignored", usage.first, printable(kind), plural(usage.first, "element"));
      const std::string_view suggestion = nearest_name(kind, kElements);
      if (!suggestion.empty() && suggestion != kind) {
        problems_.warning(usage.second, text, fmt::format("Did you mean <{}>?", suggestion));
      } else if (xacro) {
        problems_.error(usage.second, text, "This is a xacro file: run xacro on it first.");
      } else {
        problems_.note(usage.second, text, "Nothing to do, unless you need it.");
      }
    }
  }

  UrdfReader& reader_;
  Problems& problems_;
  UrdfFile file_;
  std::set<std::string, std::less<>> link_names_;
  std::set<std::string, std::less<>> joint_names_;
  std::map<std::string, int> next_suffix_;
  std::map<std::string, UrdfMaterial> materials_;
  std::set<std::string, std::less<>> declared_materials_;  // including those reported for having no color
  std::vector<SelfCollision> self_collisions_;
  std::map<std::string, std::pair<int, int>> unused_;  // element name -> count, first line
};

std::string text_of(const Problems& problems) {
  // earlier errors explain why no link is left
  std::string text;
  int count = 0;
  for (const Problem& p : problems.list()) {
    if (p.severity != Severity::error || ++count > 5) continue;
    text += fmt::format("\n  line {}: {}. {}", p.line, p.text, p.fix);
  }
  return text;
}

}  // namespace

Result<UrdfFile> check_urdf(const std::string& text, const std::string& fallback_name, Problems& problems) {
  tinyxml2::XMLDocument document;
  if (const Result<void> parsed = parse_xml(text, document); !parsed) return Error{parsed.error() + text_of(problems)};
  const Element* robot = document.RootElement();
  if (!robot) return Error{"1: <robot> element not found. Give a URDF file."};
  const std::string_view name = robot->Name();
  const std::size_t colon = name.find(':');
  const std::string prefix(colon == std::string_view::npos ? "" : name.substr(0, colon + 1));
  UrdfReader reader(problems, prefix);
  if (reader.name_of(*robot) != "robot") {
    const char* fix =
        name == "sdf" ? "SDF is another format: export the robot as URDF." : "A URDF starts with <robot name=\"…\">.";
    return Error{
        fmt::format("{}: the root element is <{}>, not <robot>. {}", robot->GetLineNum(), printable(name), fix)};
  }
  UrdfFile file = UrdfChecker(reader, problems).run(*robot, fallback_name);
  if (file.links.empty()) {
    return Error{fmt::format("{}: no valid link found. Write at least one <link name=\"…\">.{}", robot->GetLineNum(),
                             text_of(problems))};
  }
  if (static_cast<int>(file.links.size()) > kMaxUrdfLinks) {
    return Error{fmt::format("{}: there are {} links; the limit is {}. Split the robot.", robot->GetLineNum(),
                             file.links.size(), kMaxUrdfLinks)};
  }
  return file;
}

}  // namespace limber::model
