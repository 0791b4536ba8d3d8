// Robots with the results of an independent reader, and files that break naive readers. The folder is outside the
// repository; only the files that exist are tested.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "import_text.h"

namespace limber::model {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path kData = fs::path(LIMBER_SOURCE_DIR) / "../shared/data";

std::vector<fs::path> files_in(const fs::path& folder, const std::string& extension) {
  std::vector<fs::path> out;
  std::error_code fault;
  for (const auto& entry : fs::recursive_directory_iterator(folder, fault)) {
    if (entry.path().extension() == extension) out.push_back(entry.path());
  }
  std::sort(out.begin(), out.end());
  return out;
}

Vec3 vec_of(const json& j) { return {j.at(0), j.at(1), j.at(2)}; }

void expect_links(const BodyModel& model, const json& expected, const std::string& label) {
  ASSERT_EQ(model.file_links.size(), expected.at("n_links").get<std::size_t>()) << label;
  for (const FileLink& link : model.file_links) {
    const json& e = expected.at("links").at(link.name);
    EXPECT_NEAR(link.mass, e.at("mass").get<double>(), 1e-9) << label << link.name;
    EXPECT_EQ(link.collisions, e.at("collisions").get<int>()) << label << link.name;
    EXPECT_EQ(link.visuals, e.at("visuals").get<int>()) << label << link.name;
    test::expect_near(link.center, vec_of(e.at("com")), 1e-9, label + link.name);
    const json& home = expected.at("home").at(link.name);
    test::expect_near(link.home.position, vec_of(home.at("xyz")), 1e-5, label + link.name);
    const json& q = home.at("quat_xyzw");
    EXPECT_NEAR(test::angle_between(link.home.rotation, quat_xyzw(q.at(0), q.at(1), q.at(2), q.at(3))), 0, 1e-5)
        << label << link.name;
  }
}

void expect_joints(const BodyModel& model, const json& expected, const std::string& label) {
  ASSERT_EQ(model.file_joints.size(), expected.at("n_joints").get<std::size_t>()) << label;
  for (const FileJoint& joint : model.file_joints) {
    const json& e = expected.at("joints").at(joint.name);
    EXPECT_EQ(joint.type, e.at("type").get<std::string>()) << label << joint.name;
    EXPECT_EQ(joint.parent, e.at("parent").get<std::string>()) << label << joint.name;
    EXPECT_EQ(joint.child, e.at("child").get<std::string>()) << label << joint.name;
    test::expect_near(joint.axis, normalized(vec_of(e.at("axis"))), 1e-9, label + joint.name);
    if (!e.contains("limit") || joint.type == "continuous") continue;
    const json& limit = e.at("limit");
    EXPECT_EQ(joint.free, limit.at("lower").is_null()) << label << joint.name;
    if (joint.free) continue;
    EXPECT_NEAR(joint.lower, limit.at("lower").get<double>(), 1e-9) << label << joint.name;
    EXPECT_NEAR(joint.upper, limit.at("upper").get<double>(), 1e-9) << label << joint.name;
  }
}

/// Checks forward kinematics by the model's joint frames, which the simulation uses.
void expect_posed(const BodyModel& model, const json& expected, const std::string& label) {
  std::vector<Pose> pose(model.links.size());
  for (const JointModel& joint : model.joints) {
    const json& posed_q = expected.at("posed_q");
    const double q = posed_q.contains(joint.name) ? posed_q.at(joint.name).get<double>() : 0;
    Pose move;
    if (joint.type == JointType::prismatic) move.position = {0, 0, q};
    if (joint.type == JointType::revolute || joint.type == JointType::continuous)
      move.rotation = quat_axis({0, 0, 1}, q);
    pose[static_cast<std::size_t>(joint.child)] =
        pose[static_cast<std::size_t>(joint.parent)] * joint.frame_in_parent * move * joint.frame_in_child.inverse();
  }
  for (std::size_t i = 0; i < pose.size(); ++i) {
    const json& e = expected.at("posed").at(model.links[i].name);
    test::expect_near(pose[i].position, vec_of(e.at("xyz")), 1e-5, label + model.links[i].name);
  }
}

TEST(SharedData, RobotsAgreeWithTheIndependentReader) {
  for (const char* set : {"arms", "urdf_synthetic"}) {
    for (const fs::path& file : files_in(kData / set / "expected", ".json")) {
      const std::string name = file.stem().string();
      const fs::path urdf =
          std::string(set) == "arms" ? kData / set / name / "robot.urdf" : kData / set / (name + ".urdf");
      const json expected = json::parse(std::ifstream(file));
      const auto model = import_urdf(urdf.string());
      ASSERT_TRUE(model) << model.error();
      expect_links(**model, expected, name + " ");
      expect_joints(**model, expected, name + " ");
      expect_posed(**model, expected, name + " ");
      for (const Problem& p : (*model)->problems) EXPECT_NE(p.severity, Severity::error) << name << ": " << p.text;
    }
  }
}

/// Expected result of an invalid file: number of links and joints in the tree (0: nothing), and a part of a message.
struct Expected {
  std::size_t links;
  std::size_t joints;
  const char* message;
};

const std::map<std::string, Expected> kBad{
    {"axis_missing", {2, 1, "no axis"}},
    {"axis_no_xyz", {2, 1, "no axis"}},
    {"axis_tiny", {2, 1, "length 1e-200"}},
    {"axis_unnorm", {2, 1, "length 5"}},
    {"axis_zero", {2, 1, "not a direction"}},
    {"box_negative", {1, 0, "out of range"}},
    {"cycle_detached", {1, 0, "loop"}},
    {"cycle_reachable", {3, 2, "close a loop"}},
    {"dag_bomb_2pow40", {41, 40, "close a loop"}},
    {"deep_1000", {1, 0, "nested"}},
    {"deep_20000", {1, 0, "nested"}},
    {"deep_60000", {1, 0, "nested"}},
    {"dup_joint", {2, 1, "declared twice"}},
    {"dup_link", {1, 0, "declared twice"}},
    {"dup_material", {1, 0, "declared twice"}},
    {"dynamics_empty", {2, 1, "<dynamics>"}},
    {"floating", {2, 1, "no mass"}},
    {"fmt_box", {1, 0, "not a number"}},
    {"fmt_mass", {1, 0, "not a number"}},
    {"fmt_material_name", {1, 0, "no color"}},
    {"fmt_origin_xyz", {1, 0, "not a number"}},
    {"fmt_percent_x_leak", {1, 0, "not a number"}},
    {"fmt_radius", {1, 0, "not a number"}},
    {"limit_equal", {2, 1, "no mass"}},
    {"limit_inverted", {2, 1, "above upper"}},
    {"limit_missing", {2, 1, "no <limit>"}},
    {"limit_no_effort", {2, 1, "effort"}},
    {"limit_no_lower", {2, 1, "no lower"}},
    {"lost_all_after_bad_inertial", {1, 0, "no <inertia>"}},
    {"lost_collision_capsule", {1, 0, "notation"}},
    {"mass_trailing_space", {1, 0, "notation"}},
    {"mesh_no_filename", {1, 0, "names no file"}},
    {"mesh_scale_zero", {1, 0, "scale of 0"}},
    {"mesh_traversal", {1, 0, "not a supported mesh format"}},
    {"mimic_cycle", {3, 2, "cycle"}},
    {"mimic_self", {2, 1, "itself"}},
    {"mimic_unknown", {2, 1, "'nope'"}},
    {"no_root_loop", {0, 0, "cycle"}},
    {"num_mass_big", {1, 0, "out of range"}},
    {"num_mass_comma", {1, 0, "not a number"}},
    {"num_mass_dexp", {1, 0, "not a number"}},
    {"num_mass_dot", {1, 0, "notation"}},
    {"num_mass_dotend", {1, 0, "notation"}},
    {"num_mass_empty", {1, 0, "is empty"}},
    {"num_mass_hex", {1, 0, "not a number"}},
    {"num_mass_inf", {1, 0, "not finite"}},
    {"num_mass_lead", {1, 0, "notation"}},
    {"num_mass_minus", {1, 0, "out of range"}},
    {"num_mass_nan", {1, 0, "not finite"}},
    {"num_mass_overflow", {1, 0, "too large"}},
    {"num_mass_plus", {1, 0, "notation"}},
    {"num_mass_suffix", {1, 0, "not a number"}},
    {"num_mass_tab", {1, 0, "notation"}},
    {"num_mass_underflow", {1, 0, "no mass"}},
    {"num_rpy_huge", {2, 1, "out of range"}},
    {"num_xyz_comma", {2, 1, "not a number"}},
    {"num_xyz_commas", {2, 1, "not a number"}},
    {"num_xyz_dblspace", {2, 1, "no mass"}},
    {"num_xyz_empty", {2, 1, "0 numbers"}},
    {"num_xyz_four", {2, 1, "4 numbers"}},
    {"num_xyz_huge", {2, 1, "out of range"}},
    {"num_xyz_inf", {2, 1, "not finite"}},
    {"num_xyz_nan", {2, 1, "not finite"}},
    {"num_xyz_newline", {2, 1, "notation"}},
    {"num_xyz_tabs", {2, 1, "notation"}},
    {"num_xyz_trail", {2, 1, "no mass"}},
    {"num_xyz_two", {2, 1, "2 numbers"}},
    {"planar", {2, 1, "no axis"}},
    {"prismatic_no_limit", {2, 1, "no <limit>"}},
    {"safety_no_kvel", {2, 1, "safety_controller"}},
    {"self_parent_plus_root", {1, 0, "to itself"}},
    {"stamp2", {0, 0, "no valid link"}},
    {"stamp_cve_2021_42260", {0, 0, "no XML element"}},
    {"two_parents", {4, 3, "close a loop"}},
    {"two_roots", {1, 0, "not connected"}},
    {"type_case", {2, 1, "read as revolute"}},
    {"type_missing", {2, 1, "no type"}},
    {"type_unknown", {2, 1, "the limits of a spherical joint are ignored"}},
    {"undefined_parent", {1, 0, "does not exist"}},
    {"unnamed_link", {0, 0, "no name"}},
    {"unnamed_link_two", {0, 0, "no name"}},
    {"xml_attr_noquote", {1, 0, "no quotes"}},
    {"xml_bad_entity", {1, 0, "hard to write"}},
    {"xml_billion_laughs", {1, 0, "DOCTYPE"}},
    {"xml_binary", {0, 0, "can't be"}},
    {"xml_bom", {1, 0, "byte order mark"}},
    {"xml_cdata", {1, 0, "text inside <robot>"}},
    {"xml_charref", {1, 0, "no mass"}},
    {"xml_dup_attr", {0, 0, "attribute"}},
    {"xml_empty", {0, 0, "is empty"}},
    {"xml_garbage_after", {1, 0, "text after the end"}},
    {"xml_latin1", {1, 0, "Latin-1"}},
    {"xml_lf_before_decl", {1, 0, "no mass"}},
    {"xml_mismatch", {0, 0, "end tag"}},
    {"xml_namespace", {1, 0, "prefix"}},
    {"xml_no_robot", {0, 0, "<sdf>"}},
    {"xml_noname", {1, 0, "no usable name"}},
    {"xml_nul", {1, 0, "control character"}},
    {"xml_nul_mid", {1, 0, "control character"}},
    {"xml_truncated", {0, 0, "ends inside"}},
    {"xml_two_roots", {1, 0, "text after the end"}},
    {"xml_utf16", {0, 0, "UTF-16"}},
    {"xml_version2", {1, 0, "'2.0'"}},
    {"xml_version_bad", {1, 0, "'1'"}},
    {"xml_xxe", {1, 0, "DOCTYPE"}},
    {"tinyxml_cve_2021_42260_hang", {0, 0, "control character"}},
    {"tinyxml_cve_2023_34194_assert", {0, 0, "no XML element"}},
    {"tinyxml_readtext_overread_1", {0, 0, "."}},
    {"tinyxml_readtext_overread_2", {0, 0, "."}},
};

TEST(SharedData, BadFilesLoadValidContentAndReportTheRest) {
  for (const fs::path& file : files_in(kData / "urdf_bad", ".urdf")) {
    const std::string name = file.stem().string();
    const auto known = kBad.find(name);
    ASSERT_NE(known, kBad.end()) << name << " is not in kBad: add its expected result";
    const Expected& e = known->second;
    const auto model = import_urdf(file.string());
    ASSERT_EQ(model.ok(), e.links > 0) << name << (model ? "" : model.error());
    if (!model) {
      EXPECT_EQ(model.error().find(file.string() + ":"), 0u) << model.error();
      EXPECT_NE(model.error().find(e.message), std::string::npos) << model.error();
      continue;
    }
    EXPECT_EQ((*model)->file_links.size(), e.links) << name;
    EXPECT_EQ((*model)->file_joints.size(), e.joints) << name;
    bool reported = false;
    for (const Problem& p : (*model)->problems) {
      EXPECT_FALSE(p.fix.empty()) << name << ": " << p.text;
      EXPECT_GT(p.line, 0) << name << ": " << p.text;
      reported = reported || p.text.find(e.message) != std::string::npos;
    }
    EXPECT_TRUE(reported) << name << "\n" << test::all_problems(**model);
  }
}

TEST(SharedData, NothingAfterABadItemIsLost) {
  const fs::path bad = kData / "urdf_bad";
  const std::map<std::string, int> collisions{
      {"lost_all_after_bad_inertial", 1}, {"lost_collision_capsule", 2}, {"mass_trailing_space", 1}};
  for (const auto& [name, count] : collisions) {
    const fs::path file = bad / (name + ".urdf");
    if (!fs::exists(file)) continue;
    const auto model = import_urdf(file.string());
    ASSERT_TRUE(model) << model.error();
    EXPECT_EQ((*model)->file_links.at(0).collisions, count) << name;
    EXPECT_DOUBLE_EQ((*model)->file_links.at(0).mass, 2) << name;
  }
}

}  // namespace
}  // namespace limber::model
