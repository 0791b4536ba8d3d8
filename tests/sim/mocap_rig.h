// MocapFixture: a world with sources of motion capture that receive messages.
#pragma once

#include <initializer_list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sim/mocap/mocap_list.h"
#include "sim/stage.h"

namespace limber::sim::test {

inline MocapSetup setup_of(std::vector<MocapMapping> messages, std::vector<std::string> joints = {},
                           std::vector<MocapBone> bones = {}) {
  MocapSetup setup;
  setup.messages = std::move(messages);
  setup.joints = std::move(joints);
  setup.bones = std::move(bones);
  return setup;
}

struct MocapFixture : WorldFixture {
  MocapList& list() { return world.sensing().mocap(); }
  MocapSource& add(MocapSetup setup, const std::string& name = "dancer") {
    Result<MocapSource*> added = list().add(name, std::make_shared<const MocapSetup>(std::move(setup)));
    EXPECT_TRUE(added.ok()) << (added.ok() ? "" : added.error());
    return **added;
  }
  /// A source that receives places at /p, "x y z" joint by joint.
  MocapSource& add_places(const std::string& name = "dancer") { return add(setup_of({{"/p", "x y z"}}), name); }
  MocapSource& play(const std::string& bvh) {
    MocapSetup setup;
    setup.axes.up = MocapAxes::Up::y;
    setup.clip = *model::parse_bvh(bvh, "test.bvh");
    return add(std::move(setup));
  }
  /// Error, or empty.
  std::string send(const std::string& address, std::initializer_list<double> numbers, const std::string& joint = "") {
    Message message{address, {}};
    if (!joint.empty()) message.args.push_back(Arg::of(joint));
    for (const double number : numbers) message.args.push_back(Arg::of(number));
    const std::optional<Result<void>> result = list().accept(message);
    if (!result) return "not received";
    return *result ? "" : result->error();
  }
  const MocapJoint& joint(const MocapSource& source, std::size_t i = 0) { return *source.joints()[i]; }
  double dt() { return world.timestep(); }
};

}  // namespace limber::sim::test
