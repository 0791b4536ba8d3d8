// limber_steps_mujoco MODEL.xml SUBSTEPS: steps the model with MuJoCo's C interface. One tick is SUBSTEPS steps.
#include <algorithm>
#include <cstdlib>
#include <memory>

#include <mujoco/mujoco.h>

#include "bench/steps/steps.h"

namespace {

using namespace limber::steps;

class Mujoco {
 public:
  Mujoco(const char* file, int substeps) : substeps_(substeps) {
    std::array<char, 500> error{};
    model_.reset(mj_loadXML(file, nullptr, error.data(), error.size()));
    if (!model_) mju_error(error.data());
    model_->opt.timestep = 1.0 / kRate;
    data_.reset(mj_makeData(model_.get()));
    if (model_->nu != kMotors || model_->nq + model_->nv != kObservations) mju_error("the model is another one");
  }
  double step(const Actions& actions, Observations& observations) {
    std::copy(actions.begin(), actions.end(), data_->ctrl);
    for (int i = 0; i < substeps_; i++) mj_step(model_.get(), data_.get());
    mjtNum* const speeds = std::copy_n(data_->qpos, model_->nq, observations.data());
    std::copy_n(data_->qvel, model_->nv, speeds);
    return observations[2];
  }
  int contacts() const { return data_->ncon; }

 private:
  struct Free {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };
  int substeps_;
  std::unique_ptr<mjModel, Free> model_;
  std::unique_ptr<mjData, Free> data_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const int substeps = std::atoi(argv[2]);
  Mujoco engine(argv[1], substeps);
  return serve(engine, substeps);
}
