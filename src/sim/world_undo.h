// WorldUndo: takes back what a guarded call of a script did to the world when the call fails. Values are kept by the
// store; here are forces, what was made, what was removed. [sim]
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/vec.h"
#include "sim/camera_moves.h"

namespace limber {

class Body;
class Gear;
class Part;
class Shape;
class World;

class WorldUndo {
 public:
  explicit WorldUndo(World& world);
  ~WorldUndo();
  WorldUndo(const WorldUndo&) = delete;
  WorldUndo& operator=(const WorldUndo&) = delete;

  /// From here on everything is kept, until end() or take_back(). Allocates only while the logs grow.
  void begin();
  /// The call ended well: what it did stays, and what it removed goes.
  void end();
  /// The call failed: the world is as it was at begin(), to the bit. What was made goes, newest first.
  void take_back();
  bool active() const { return active_; }
  /// Whether nothing was kept since begin(): there is nothing to take back.
  bool untouched() const;

  /// The forces that wait in a part, and what a body knows beside its rows: before they are changed.
  void keep(Part& part);
  void keep(Body& body);
  /// What moves the camera: before it is changed.
  void keep(CameraMoves& moves);
  /// How many children a compound has: before it gets one.
  void keep(Shape& shape);
  /// Bullet's pose and velocity of a part: before its effects run ahead of the next step.
  void keep_motion(Part& part);
  // the newest of its list was made
  void made_body();
  void made_gear();
  void made_shape();
  void made_part(Body& body);
  void made_joint(Body& body);
  void made_motor(Body& body);
  /// Takes a removed body, which stood at `place`, out of sight.
  void hide(std::unique_ptr<Body> body, std::size_t place);
  void hide(std::unique_ptr<Gear> gear, std::size_t place);

  /// For what other rooms make and change: on failure `step` is called, newest first among all that is taken back.
  using Step = void (*)(void* owner, std::size_t value);
  void note(Step step, void* owner, std::size_t value = 0);

 private:
  struct Entry {
    Step step;
    void* owner;
    std::size_t value;
  };
  struct Forces;
  struct BodyState;
  struct Motion;
  struct Hidden;
  struct HiddenGear;
  bool first_time(std::uint64_t& kept_in) const;

  World& world_;
  bool active_ = false;
  bool reset_asked_ = false;
  bool panic_asked_ = false;
  std::uint64_t call_ = 0;
  std::vector<Entry> entries_;
  std::vector<Forces> forces_;
  std::vector<BodyState> bodies_;
  CameraMoves::State moves_;
  std::vector<Motion> motions_;
  std::vector<Hidden> hidden_;
  std::vector<HiddenGear> hidden_gears_;  // go before the bodies
};

}  // namespace limber
