// What another program makes of an exported file: loaded by assimp, posed at a key, by code that knows nothing of
// Limber.
#pragma once

#include <cmath>
#include <optional>
#include <string>

#include <assimp/scene.h>
#include <gtest/gtest.h>
#include <assimp/Importer.hpp>

#include "base/vec.h"

namespace limber::motion_test {

class Loaded {
 public:
  explicit Loaded(const std::string& path) : scene_(importer_.ReadFile(path, 0)) {
    EXPECT_NE(scene_, nullptr) << importer_.GetErrorString();
  }

  const aiScene& scene() const { return *scene_; }
  const aiAnimation& animation() const { return *scene_->mAnimations[0]; }
  const aiNodeAnim* channel(const std::string& node) const {
    for (unsigned a = 0; a < scene_->mNumAnimations; a++) {
      for (unsigned c = 0; c < scene_->mAnimations[a]->mNumChannels; c++) {
        if (node == scene_->mAnimations[a]->mChannels[c]->mNodeName.C_Str())
          return scene_->mAnimations[a]->mChannels[c];
      }
    }
    return nullptr;
  }

  /// How many nodes there are below that one, itself included.
  static unsigned count(const aiNode* node) {
    unsigned sum = 1;
    for (unsigned i = 0; i < node->mNumChildren; i++) sum += count(node->mChildren[i]);
    return sum;
  }

  /// World pose of a node at a key of its channels, Y up.
  Pose pose(const std::string& name, unsigned key) const {
    const aiNode* node = scene_->mRootNode->FindNode(name.c_str());
    if (node == nullptr) {
      ADD_FAILURE() << "no node '" << name << "'";
      return {};
    }
    Pose world;
    for (; node != nullptr; node = node->mParent) world = local(node, key) * world;
    return world;
  }
  /// The same where Z is up again.
  Pose z_up(const std::string& name, unsigned key) const {
    const Quat turn = quat_axis({1, 0, 0}, kPi / 2);
    return Pose{{0, 0, 0}, turn} * pose(name, key);
  }

 private:
  Pose local(const aiNode* node, unsigned key) const {
    aiVector3D size;
    aiVector3D place;
    aiQuaternion turn;
    node->mTransformation.Decompose(size, turn, place);
    if (const aiNodeAnim* keys = channel(node->mName.C_Str())) {
      const auto at = [key](unsigned count) { return std::min(key, count - 1); };
      if (keys->mNumPositionKeys > 0) place = keys->mPositionKeys[at(keys->mNumPositionKeys)].mValue;
      if (keys->mNumRotationKeys > 0) turn = keys->mRotationKeys[at(keys->mNumRotationKeys)].mValue;
    }
    return {{place.x, place.y, place.z}, glm::normalize(quat_xyzw(turn.x, turn.y, turn.z, turn.w))};
  }

  Assimp::Importer importer_;
  const aiScene* scene_;
};

/// Angle between two rotations, rad.
inline double turn_between(const Quat& a, const Quat& b) {
  return 2 * std::acos(std::min(1.0, std::abs(glm::dot(glm::normalize(a), glm::normalize(b)))));
}

}  // namespace limber::motion_test
