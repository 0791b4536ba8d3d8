// The pass over the whole document: root, links, joints, materials, and what is there but not used.
#include "model/urdf_check.h"

#include <array>
#include <map>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"
#include "model/urdf_read.h"

namespace limber {

namespace {

using Element = tinyxml2::XMLElement;

constexpr std::size_t kShownName = 40;

constexpr std::array<std::string_view, 16> kElements{
    "link",  "joint", "material", "inertial", "visual", "collision", "origin",  "parent",
    "child", "axis",  "limit",    "dynamics", "mimic",  "geometry",  "inertia", "mass"};

const char* cure_of(tinyxml2::XMLError error) {
  switch (error) {
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      return "Close every element with its own end tag, in order.";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      return "Write each attribute once, as name=\"value\" with quotes.";
    case tinyxml2::XML_ERROR_PARSING_ELEMENT:
      return "Write <name …> and take single '<' out of texts.";
    default:
      return "Mend the XML; the file may be cut off.";
  }
}

const char* fault_of(tinyxml2::XMLError error) {
  switch (error) {
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      return "an element is not closed, or closed by another's end tag";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      return "an attribute can't be read";
    case tinyxml2::XML_ERROR_PARSING_ELEMENT:
      return "an element can't be read";
    default:
      return "the XML can't be read";
  }
}

class Check {
 public:
  Check(UrdfReader& reader, Problems& problems) : reader_(reader), problems_(problems) {}

  UrdfFile run(const Element& robot, const std::string& fallback_name) {
    root(robot, fallback_name);
    for (const Element* e = robot.FirstChildElement(); e; e = e->NextSiblingElement()) {
      const std::string_view kind = reader_.name_of(*e);
      if (kind == "link") {
        link(*e);
      } else if (kind == "joint") {
        joint(*e);
      } else if (kind == "material") {
        material(*e);
      } else {
        if (kind == "gazebo") gazebo(*e);
        ++unused_.try_emplace(std::string(kind), 0, e->GetLineNum()).first->second.first;
      }
    }
    stray_text(robot);
    colors();
    self_collisions();
    say_unused();
    reader_.finish();
    return std::move(file_);
  }

 private:
  struct SelfCollision {
    std::string link;
    bool all;
    bool on;
    int line;
  };

  void root(const Element& robot, const std::string& fallback_name) {
    const char* name = robot.Attribute("name");
    const bool usable = name && !name_fault(name);
    file_.name = usable ? name : (name_fault(fallback_name) ? "robot" : fallback_name);
    if (!usable) {
      problems_.warning(robot.GetLineNum(), fmt::format("<robot> has no usable name; called '{}'", file_.name),
                        "Write <robot name=\"…\">.");
    }
    reader_.check_attributes(robot, {"name", "version"});
    const std::string_view version = robot.Attribute("version") ? robot.Attribute("version") : "1.0";
    if (version != "1.0" && version != "1.1" && version != "1.2") {
      problems_.warning(robot.GetLineNum(), fmt::format("<robot version='{}'> is read as 1.0", printable(version)),
                        "Write version=\"1.0\", or take it out.");
    }
    if (robot.Name() != reader_.name_of(robot)) {
      problems_.warning(robot.GetLineNum(), "the root element has a namespace prefix, which URDF does not have",
                        "Write <robot …> without a prefix.");
    }
  }

  void odd_name(const Element& element, std::string_view kind, const std::string& name) {
    const bool hard = escape_name(name) != name || name.find_first_of("&<>\"'") != std::string::npos;
    if (!hard) return;
    problems_.note(element.GetLineNum(),
                   fmt::format("{} '{}': its name is hard to write in an OSC address", kind, printable(name)),
                   "Use letters, digits, '_', '-' and '.'.");
  }

  void link(const Element& element) {
    const char* name = element.Attribute("name");
    if (!name || !*name) {
      problems_.error(element.GetLineNum(), "a <link> has no name; left out", "Write <link name=\"…\">.");
      return;
    }
    if (const std::optional<std::string> fault = name_fault(name)) {
      problems_.error(element.GetLineNum(),
                      fmt::format("link '{}': its name can't be used: {}; left out",
                                  printable(std::string_view(name).substr(0, kShownName)), *fault),
                      "Give it a short, printable name.");
      return;
    }
    if (!link_names_.insert(name).second) {
      problems_.error(element.GetLineNum(), fmt::format("link '{}' is there twice; the first counts", printable(name)),
                      "Give every link a name of its own.");
      return;
    }
    odd_name(element, "link", name);
    file_.links.push_back(reader_.link(element, name));
    count_unused(element, {"inertial", "visual", "collision"});
    for (const Element* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) {
      const std::string_view kind = reader_.name_of(*e);
      if (kind == "inertial") count_unused(*e, {"origin", "mass", "inertia"});
      if (kind == "visual" || kind == "collision") count_unused(*e, {"origin", "geometry", "material"});
    }
  }

  void joint(const Element& element) {
    const char* written = element.Attribute("name");
    std::string name = written ? written : "";
    const std::optional<std::string> fault = name_fault(name);
    if (fault) {
      const Element* child = reader_.child(element, "child");
      const char* link = child ? child->Attribute("link") : nullptr;
      name = fmt::format("{}_joint", link && !name_fault(link) ? link : "unnamed");
      problems_.warning(element.GetLineNum(),
                        written
                            ? fmt::format("a <joint>'s name can't be used: {}; called '{}'", *fault, printable(name))
                            : fmt::format("a <joint> has no name; called '{}'", printable(name)),
                        "Write <joint name=\"…\">, short and printable.");
    }
    std::optional<UrdfJoint> read = reader_.joint(element, name);
    count_unused(element, {"origin", "parent", "child", "axis", "limit", "dynamics", "mimic"});
    if (!read) return;
    odd_name(element, "joint", name);
    if (!joint_names_.insert(name).second) rename(*read);
    file_.joints.push_back(std::move(*read));
  }

  // a second joint of the same name still carries its part of the body
  void rename(UrdfJoint& joint) {
    const std::string base = joint.name;
    int& next = next_suffix_.try_emplace(base, 2).first->second;
    do {
      joint.name = fmt::format("{}_{}", base, next++);
    } while (!joint_names_.insert(joint.name).second);
    problems_.error(
        joint.line,
        fmt::format("joint '{}' is there twice; the second is called '{}'", printable(base), printable(joint.name)),
        "Give every joint a name of its own.");
  }

  void material(const Element& element) {
    const char* name = element.Attribute("name");
    if (!name || !*name) {
      problems_.warning(element.GetLineNum(), "a <material> has no name; not used", "Write <material name=\"…\">.");
      return;
    }
    reader_.check_attributes(element, {"name"});
    const std::string owner = fmt::format("material '{}'", printable(name));
    std::optional<Vec3> color;
    double alpha = 1;
    declared_materials_.insert(name);
    if (!reader_.color(element, owner, color, alpha)) {
      problems_.warning(element.GetLineNum(), owner + " has no colour; not used",
                        "Write <color rgba=\"r g b a\"/> inside; textures are not used.");
    } else if (!materials_.try_emplace(name, *color, alpha).second) {
      problems_.warning(element.GetLineNum(), owner + " is there twice; the first counts",
                        "Give every material a name of its own.");
    }
  }

  // materials that links define in place may be named by others, too
  void colors() {
    std::map<std::string, std::pair<int, int>> undefined;  // how many visuals, the first's line
    for (const UrdfLink& link : file_.links) {
      for (const UrdfShape& shape : link.visuals) {
        if (shape.color && !shape.material.empty()) materials_.try_emplace(shape.material, *shape.color, shape.alpha);
      }
    }
    for (UrdfLink& link : file_.links) {
      for (UrdfShape& shape : link.visuals) {
        if (shape.color || shape.material.empty()) continue;
        const auto found = materials_.find(shape.material);
        if (found != materials_.end()) {
          std::tie(shape.color, shape.alpha) = found->second;
        } else if (!declared_materials_.contains(shape.material)) {
          ++undefined.try_emplace(shape.material, 0, shape.line).first->second.first;
        }
      }
    }
    for (const auto& [name, seen] : undefined) {
      const std::string places = seen.first == 1 ? "a visual" : fmt::format("{} visuals", seen.first);
      problems_.warning(seen.second,
                        fmt::format("material '{}' of {} is not defined; the default color is used",
                                    printable(std::string_view(name).substr(0, kShownName)), places),
                        "Write <material name=\"…\"><color rgba=\"r g b a\"/></material> inside <robot>.");
    }
  }

  // <gazebo reference="link"><selfCollide>; without a reference it is for all links
  void gazebo(const Element& element) {
    for (const char* const name : {"selfCollide", "self_collide"}) {
      const Element* const found = reader_.child(element, name);
      if (!found) continue;
      const std::string_view text = found->GetText() ? found->GetText() : "";
      const bool on = same_name(text, "true") || same_name(text, "1");
      if (!on && !same_name(text, "false") && !same_name(text, "0")) {
        problems_.warning(found->GetLineNum(),
                          fmt::format("<{}> is '{}'; ignored", name, printable(text.substr(0, kShownName))),
                          "Write true or false.");
        continue;
      }
      const char* const link = element.Attribute("reference");
      self_collisions_.push_back({link ? link : "", link == nullptr, on, found->GetLineNum()});
    }
  }

  // that of a single link wins
  void self_collisions() {
    for (const bool all : {true, false}) {
      for (const SelfCollision& said : self_collisions_) {
        if (said.all != all) continue;
        bool found = all;
        for (UrdfLink& link : file_.links) {
          if (!all && link.name != said.link) continue;
          link.self_collision = said.on;
          found = true;
        }
        if (found) continue;
        const std::vector<std::string> names(link_names_.begin(), link_names_.end());
        problems_.warning(
            said.line,
            fmt::format("<gazebo reference='{}'> with <selfCollide> names no link{}; ignored",
                        printable(std::string_view(said.link).substr(0, kShownName)), name_hint(said.link, names)),
            "Name a link of this file.");
      }
    }
  }

  void stray_text(const Element& robot) {
    for (const tinyxml2::XMLNode* node = robot.FirstChild(); node; node = node->NextSibling()) {
      if (!node->ToText()) continue;
      problems_.warning(node->GetLineNum(), "there is bare text inside <robot>; not used", "Take it out.");
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

  void say_unused() {
    constexpr std::size_t kMostKinds = 40;
    std::size_t kinds = 0;
    for (const auto& [kind, seen] : unused_) {
      if (++kinds > kMostKinds) break;
      const bool xacro = kind.starts_with("xacro:");
      const std::string text =
          fmt::format("{} <{}> element{} not used", seen.first, printable(kind), seen.first == 1 ? " is" : "s are");
      const std::string_view meant = nearest_name(kind, kElements);
      if (!meant.empty() && meant != kind) {
        problems_.warning(seen.second, text, fmt::format("Did you mean <{}>?", meant));
      } else if (xacro) {
        problems_.error(seen.second, text, "This is a xacro file: run xacro on it first.");
      } else {
        problems_.note(seen.second, text, "Nothing to do, unless you counted on it.");
      }
    }
  }

  UrdfReader& reader_;
  Problems& problems_;
  UrdfFile file_;
  std::set<std::string, std::less<>> link_names_;
  std::set<std::string, std::less<>> joint_names_;
  std::map<std::string, int> next_suffix_;
  std::map<std::string, std::pair<Vec3, double>> materials_;
  std::set<std::string, std::less<>> declared_materials_;  // also those without a color, which is reported
  std::vector<SelfCollision> self_collisions_;
  std::map<std::string, std::pair<int, int>> unused_;  // kind -> how many, first line
};

std::string text_of(const Problems& problems) {
  // what else was found helps to see why nothing is left
  std::string text;
  int count = 0;
  for (const Problem& p : problems.list()) {
    if (p.severity != Severity::error || ++count > 5) continue;
    text += fmt::format("\n  line {}: {}. {}", p.line, p.text, p.cure);
  }
  return text;
}

}  // namespace

Result<UrdfFile> check_urdf(const std::string& text, const std::string& fallback_name, Problems& problems) {
  tinyxml2::XMLDocument document;
  document.Parse(text.data(), text.size());
  if (document.Error()) {
    const tinyxml2::XMLError error = document.ErrorID();
    return Error{
        fmt::format("{}: {}. {}{}", document.ErrorLineNum(), fault_of(error), cure_of(error), text_of(problems))};
  }
  const Element* robot = document.RootElement();
  if (!robot) return Error{"1: there is no <robot> element. Give a URDF file."};
  const std::string_view name = robot->Name();
  const std::size_t colon = name.find(':');
  const std::string prefix(colon == std::string_view::npos ? "" : name.substr(0, colon + 1));
  UrdfReader reader(problems, prefix);
  if (reader.name_of(*robot) != "robot") {
    const char* cure =
        name == "sdf" ? "SDF is another format: export the robot as URDF." : "A URDF starts with <robot name=\"…\">.";
    return Error{
        fmt::format("{}: the root element is <{}>, not <robot>. {}", robot->GetLineNum(), printable(name), cure)};
  }
  UrdfFile file = Check(reader, problems).run(*robot, fallback_name);
  if (file.links.empty()) {
    return Error{fmt::format("{}: no link is left to make a body of. Write at least one <link name=\"…\">.{}",
                             robot->GetLineNum(), text_of(problems))};
  }
  if (static_cast<int>(file.links.size()) > kMostUrdfLinks) {
    return Error{fmt::format("{}: there are {} links; at most {} are read. Split the robot.", robot->GetLineNum(),
                             file.links.size(), kMostUrdfLinks)};
  }
  return file;
}

}  // namespace limber
