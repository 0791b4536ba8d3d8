// limber_steps_library SCENE.lua SUBSTEPS: steps the scene with limber.h. One tick has SUBSTEPS substeps.
#include <algorithm>
#include <cstdlib>
#include <string>

#include "bench/steps/steps.h"
#include "lib/limber.h"

namespace {

using namespace limber::steps;

void check(limber_status status) {
  if (status == LIMBER_OK) return;
  std::fprintf(stderr, "%s\n", limber_last_error());
  std::exit(1);
}

class Library {
 public:
  Library(const char* file, int substeps) {
    limber_options options = LIMBER_OPTIONS;
    options.file = file;
    check(limber_create(&options, &sim_));
    set("/physics/sim/timestep", static_cast<double>(substeps) / kRate);
    set("/physics/sim/substeps", substeps);
    targets_ = find("/physics/body/dog/motor/*/target");
    std::size_t size = 0;
    for (const char* name : {"joint/*/value", "joint/*/speed", "part/trunk/position", "part/trunk/rotation",
                             "part/trunk/linear_velocity", "part/trunk/angular_velocity"}) {
      Seen& seen = seen_[count_++];
      seen.property = find("/physics/body/dog/" + std::string(name));
      seen.offset = size;
      seen.size = limber_count(seen.property) * limber_width(seen.property);
      size += seen.size;
    }
    if (size != kObservations || limber_count(targets_) != kMotors) std::exit(1);
  }
  ~Library() { limber_destroy(sim_); }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  double step(const Actions& actions, Observations& observations) {
    check(limber_write(targets_, actions.data(), actions.size()));
    check(limber_step(sim_, 1));
    for (const Seen& seen : seen_) check(limber_read(seen.property, &observations[seen.offset], seen.size));
    return observations[2 * kMotors + 2];
  }
  static int contacts() { return -1; }

 private:
  struct Seen {
    limber_property* property = nullptr;
    std::size_t offset = 0;
    std::size_t size = 0;
  };
  limber_property* find(const std::string& address) {
    limber_property* property = nullptr;
    check(limber_find(sim_, address.c_str(), &property));
    return property;
  }
  void set(const char* address, double value) {
    const limber_value argument{LIMBER_NUMBER, value, nullptr};
    check(limber_send(sim_, address, &argument, 1));
  }

  limber_sim* sim_ = nullptr;
  limber_property* targets_ = nullptr;
  std::array<Seen, 6> seen_;
  std::size_t count_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const int substeps = std::atoi(argv[2]);
  Library engine(argv[1], substeps);
  return serve(engine, substeps);
}
