// Texts of --param and --seeds.
#include "experiments/axis.h"

#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace limber::experiments::test {
namespace {

const ParameterInfo kRate{"rate", 0, 2, 0.5, {}, false};
const ParameterInfo kGait{"gait", 0, 2, 0, {"walk", "trot", "bound"}, true};

std::vector<double> values(const std::string& text, const ParameterInfo& parameter) {
  const Result<AxisText> parsed = parse_axis(text);
  if (!parsed) return {};
  const Result<Axis> axis = make_axis(*parsed, parameter);
  return axis ? axis->values : std::vector<double>();
}

std::string error(const std::string& text, const ParameterInfo& parameter = kRate) {
  const Result<AxisText> parsed = parse_axis(text);
  if (!parsed) return parsed.error();
  const Result<Axis> axis = make_axis(*parsed, parameter);
  return axis ? "" : axis.error();
}

TEST(Axis, StepsAreTheNumbersThatPeopleWrite) {
  const std::vector<double> tenths{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};
  EXPECT_EQ(values("rate=0.1:1:0.1", kRate), tenths);
  EXPECT_EQ(values("rate=0:1:0.4", kRate), (std::vector<double>{0, 0.4, 0.8}));
}

TEST(Axis, CountsIncludeBothEnds) {
  EXPECT_EQ(values("rate=0:1/5", kRate), (std::vector<double>{0, 0.25, 0.5, 0.75, 1}));
  EXPECT_EQ(values("rate=0.2:0.4/2", kRate), (std::vector<double>{0.2, 0.4}));
}

TEST(Axis, ListsKeepTheirOrder) {
  EXPECT_EQ(values("rate=0.4,0.2,1e-1", kRate), (std::vector<double>{0.4, 0.2, 0.1}));
  EXPECT_EQ(values("gait=bound,walk", kGait), (std::vector<double>{2, 0}));
}

TEST(Axis, RangeOfAChoiceHasItsWholeNumbers) {
  const Result<Axis> axis = whole_axis(kGait);
  ASSERT_TRUE(axis.ok());
  EXPECT_EQ(axis->values, (std::vector<double>{0, 1, 2}));
  EXPECT_EQ(axis->text(1), "trot");
  // three equal intervals
  EXPECT_EQ(axis->at(0), 0);
  EXPECT_EQ(axis->at(0.34), 1);
  EXPECT_EQ(axis->at(0.99), 2);
  EXPECT_EQ(axis->at(1), 2);
}

TEST(Axis, ErrorsNameTheParameterAndTheFix) {
  EXPECT_NE(error("rate").find("write NAME=MIN:MAX:STEP"), std::string::npos);
  EXPECT_NE(error("rate=1:0.5:0.1").find("MIN is below MAX"), std::string::npos);
  EXPECT_NE(error("rate=0:1:0").find("MIN is below MAX"), std::string::npos);
  EXPECT_NE(error("rate=0:1/1").find("N at least 2"), std::string::npos);
  EXPECT_NE(error("rate=1,,2").find("an item of the list is empty"), std::string::npos);
  EXPECT_NE(error("rate=fast").find("'fast' is not a number"), std::string::npos);
  EXPECT_EQ(error("rate=0:3:0.5"), "--param rate: values must be within 0 .. 2");
  EXPECT_EQ(error("gait=0.5", {"gait", 0, 1, 0, {}, true}), "--param gait: values must be whole numbers within 0 .. 1");
  EXPECT_NE(error("gait=trott", kGait).find("did you mean 'trot'?"), std::string::npos);
}

TEST(Axis, UnknownNamesGetAHint) {
  const Result<AxisText> text = parse_axis("rat=0:1:1");
  ASSERT_TRUE(text.ok());
  const Result<std::vector<Axis>> axes = make_axes({*text}, {kRate, kGait});
  ASSERT_FALSE(axes.ok());
  EXPECT_NE(axes.error().find("--param rat: the scene has no such parameter; did you mean 'rate'?"), std::string::npos)
      << axes.error();
  EXPECT_NE(make_axes({}, {}).error().find("declare them with params"), std::string::npos);
}

TEST(Axis, WithoutTextsAllParametersWithARangeVary) {
  const ParameterInfo unbounded{"mass", 0, std::numeric_limits<double>::infinity(), 1, {}, false};
  const Result<std::vector<Axis>> axes = make_axes({}, {kRate, unbounded, kGait});
  ASSERT_TRUE(axes.ok());
  ASSERT_EQ(axes->size(), 2u);
  EXPECT_EQ((*axes)[0].name, "rate");
  EXPECT_EQ((*axes)[0].max, 2);
  EXPECT_EQ((*axes)[1].name, "gait");
}

TEST(Axis, Seeds) {
  EXPECT_EQ(*parse_seeds("1:5"), (std::vector<std::uint64_t>{1, 2, 3, 4, 5}));
  EXPECT_EQ(*parse_seeds("7"), std::vector<std::uint64_t>{7});
  EXPECT_EQ(*parse_seeds("3,1,9007199254740992"), (std::vector<std::uint64_t>{3, 1, 9007199254740992u}));
  for (const char* wrong : {"", "5:1", "1:2:3", "a", "-1", "1.5", "1,", "0:1000000000"})
    EXPECT_FALSE(parse_seeds(wrong).ok()) << wrong;
}

}  // namespace
}  // namespace limber::experiments::test
