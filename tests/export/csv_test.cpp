// CSV writer: exact text, and cells read by a standard CSV parser.
#include "export/writers.h"

#include "export/rig.h"

namespace limber::exporter::test {
namespace {

using CsvTest = MotionTest;

using Table = std::vector<std::vector<std::string>>;

Table read_table(const std::string& text) {
  Table table(1, {""});
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); i++) {
    const char c = text[i];
    if (c == '"') {
      if (quoted && i + 1 < text.size() && text[i + 1] == '"') {
        table.back().back() += text[i++];
      } else {
        quoted = !quoted;
      }
    } else if (c == ',' && !quoted) {
      table.back().emplace_back();
    } else if (c == '\n' && !quoted) {
      table.push_back({""});
    } else {
      table.back().back() += c;
    }
  }
  table.pop_back();
  return table;
}

MotionBody ball(const std::string& name) { return {name, {{"ball", -1, {}, nullptr}}, {}}; }
MotionSample ball_at(double x) { return {true, {Pose{{x, 0, 1}}}, {}}; }

TEST_F(CsvTest, WritesOneLinePerFrame) {
  const auto writer = opened(make_csv_writer(path("a.csv")));
  const MotionBody hinge{"door", {{"leaf", -1, {}, nullptr}}, {{"hinge", {"angle"}}}};
  ASSERT_EQ(error_text(writer->add_body(hinge)), "");
  const Quat half = quat_xyzw(0, 0, 1, 0);
  ASSERT_EQ(error_text(writer->add_frame(0, std::vector{MotionSample{true, {{{1, 2.5, -3}, half}}, {0.25}}})), "");
  ASSERT_EQ(error_text(writer->add_frame(0.04, std::vector{MotionSample{true, {Pose{}}, {0.1}}})), "");
  EXPECT_TRUE(text("a.csv").empty()) << "not before finish()";
  ASSERT_EQ(error_text(writer->finish()), "");
  EXPECT_EQ(text("a.csv"),
            "time,door/part/leaf/x,door/part/leaf/y,door/part/leaf/z,door/part/leaf/qx,door/part/leaf/qy,"
            "door/part/leaf/qz,door/part/leaf/qw,door/joint/hinge/angle\n"
            "0,1,2.5,-3,0,0,1,0,0.25\n"
            "0.04,0,0,0,0,0,0,1,0.1\n");
  EXPECT_EQ(files(), std::vector<std::string>{"a.csv"});
}

TEST_F(CsvTest, AbsentBodiesHaveEmptyCells) {
  const auto writer = opened(make_csv_writer(path("a.csv")));
  ASSERT_EQ(error_text(writer->add_body(ball("a"))), "");
  ASSERT_EQ(error_text(writer->add_frame(0, std::vector{ball_at(0)})), "");
  ASSERT_EQ(error_text(writer->add_frame(1, std::vector{ball_at(1)})), "");
  ASSERT_EQ(error_text(writer->add_body(ball("b"))), "");
  ASSERT_EQ(error_text(writer->add_frame(2, std::vector{absent(), ball_at(20)})), "");
  ASSERT_EQ(error_text(writer->add_body(ball("c"))), "");
  ASSERT_EQ(error_text(writer->add_frame(3, std::vector{ball_at(3), absent(), ball_at(300)})), "");
  ASSERT_EQ(error_text(writer->finish()), "");
  const Table table = read_table(text("a.csv"));
  ASSERT_EQ(table.size(), 5u);
  for (const auto& row : table) ASSERT_EQ(row.size(), 22u);
  EXPECT_EQ(table[0][8], "b/part/ball/x");
  EXPECT_EQ(table[0][15], "c/part/ball/x");
  const std::vector<std::array<std::string, 4>> places = {
      {"0", "0", "", ""}, {"1", "1", "", ""}, {"2", "", "20", ""}, {"3", "3", "", "300"}};
  for (std::size_t i = 0; i < places.size(); i++) {
    const auto& row = table[i + 1];
    EXPECT_EQ((std::array{row[0], row[1], row[8], row[15]}), places[i]) << i;
    for (const std::size_t first : {1u, 8u, 15u}) {
      for (std::size_t k = 1; k < 7; k++)
        EXPECT_EQ(row[first + k].empty(), row[first].empty()) << "a body has all its cells or none";
    }
  }
  EXPECT_EQ(files(), std::vector<std::string>{"a.csv"});
}

// a file larger than the chunks in which it is rewritten
TEST_F(CsvTest, PadsManyLines) {
  const auto writer = opened(make_csv_writer(path("a.csv")));
  ASSERT_EQ(error_text(writer->add_body(ball("a"))), "");
  for (int i = 0; i < 20000; i++) ASSERT_EQ(error_text(writer->add_frame(i, std::vector{ball_at(i)})), "");
  ASSERT_EQ(error_text(writer->add_body(ball("b"))), "");
  ASSERT_EQ(error_text(writer->add_frame(20000, std::vector{ball_at(20000), ball_at(7)})), "");
  ASSERT_EQ(error_text(writer->finish()), "");
  const Table table = read_table(text("a.csv"));
  ASSERT_EQ(table.size(), 20002u);
  for (int i = 0; i < 20000; i++) {
    const auto& row = table[static_cast<std::size_t>(i) + 1];
    ASSERT_EQ(row.size(), 15u) << i;
    ASSERT_EQ(row[1], std::to_string(i));
    ASSERT_EQ(row[8], "");
  }
  EXPECT_EQ(table.back()[8], "7");
}

TEST_F(CsvTest, QuotesNamesForOneColumnEach) {
  const auto writer = opened(make_csv_writer(path("a.csv")));
  for (const char* name : {"a, \"b\"/c", "größe 雪", "same", "same"})
    ASSERT_EQ(error_text(writer->add_body(ball(name))), "");
  ASSERT_EQ(error_text(writer->add_frame(0, std::vector{ball_at(0), ball_at(1), ball_at(2), ball_at(3)})), "");
  ASSERT_EQ(error_text(writer->finish()), "");
  const Table table = read_table(text("a.csv"));
  ASSERT_EQ(table.size(), 2u);
  ASSERT_EQ(table[0].size(), 29u);
  EXPECT_EQ(table[0][1], "a%2C%20\"b\"%2Fc/part/ball/x") << "escaped as in OSC addresses";
  EXPECT_EQ(table[0][8], "größe%20雪/part/ball/x");
  EXPECT_EQ(table[0][15], "same/part/ball/x");
  EXPECT_EQ(table[0][22], "same-2/part/ball/x");
}

TEST_F(CsvTest, WritesTheTimeWithoutBodies) {
  const auto writer = opened(make_csv_writer(path("a.csv")));
  ASSERT_EQ(error_text(writer->add_frame(0, {})), "");
  ASSERT_EQ(error_text(writer->add_frame(0.5, {})), "");
  ASSERT_EQ(error_text(writer->finish()), "");
  EXPECT_EQ(text("a.csv"), "time\n0\n0.5\n");
}

TEST_F(CsvTest, LeavesNoUnfinishedFile) {
  std::ofstream(path("a.csv")) << "previous";
  {
    const auto writer = opened(make_csv_writer(path("a.csv")));
    ASSERT_EQ(error_text(writer->add_body(ball("a"))), "");
    for (int i = 0; i < 5000; i++) ASSERT_EQ(error_text(writer->add_frame(i, std::vector{ball_at(i)})), "");
    EXPECT_EQ(files().size(), 2u) << "the temporary file";
  }
  EXPECT_EQ(text("a.csv"), "previous");
  EXPECT_EQ(files(), std::vector<std::string>{"a.csv"});
}

TEST_F(CsvTest, ReportsAFullDiskAndLeavesNoFile) {
  {
    const auto writer = opened(make_csv_writer(path("a.csv")));
    ASSERT_EQ(error_text(writer->add_body(ball("a"))), "");
    const FullDisk full(100000);
    std::string error;
    for (int i = 0; i < 20000 && error.empty(); i++) error = error_text(writer->add_frame(i, std::vector{ball_at(i)}));
    EXPECT_EQ(error, path("a.csv") + " can't be written: File too large");
  }
  EXPECT_EQ(files(), std::vector<std::string>{});
  const auto nowhere = make_csv_writer(path("no/a.csv"));
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error(), path("no/a.csv") + " can't be written: No such file or directory");
}

}  // namespace
}  // namespace limber::exporter::test
