// Loaded: an exported file as loaded by assimp and posed at a keyframe, independent of Limber's code.
#pragma once

#include <cmath>
#include <optional>
#include <string>

#include <assimp/scene.h>
#include <gtest/gtest.h>
#include <assimp/Importer.hpp>

#include "base/vec.h"

namespace limber::exporter::test {

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

  /// Number of nodes in the subtree of a node, including itself.
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
  /// World pose of a node at a key, converted to Z up.
  Pose z_up(const std::string& name, unsigned key) const {
    const Quat rotation = quat_axis({1, 0, 0}, kPi / 2);
    return Pose{{0, 0, 0}, rotation} * pose(name, key);
  }

 private:
  Pose local(const aiNode* node, unsigned key) const {
    aiVector3D size;
    aiVector3D position;
    aiQuaternion rotation;
    node->mTransformation.Decompose(size, rotation, position);
    if (const aiNodeAnim* keys = channel(node->mName.C_Str())) {
      const auto at = [key](unsigned count) { return std::min(key, count - 1); };
      if (keys->mNumPositionKeys > 0) position = keys->mPositionKeys[at(keys->mNumPositionKeys)].mValue;
      if (keys->mNumRotationKeys > 0) rotation = keys->mRotationKeys[at(keys->mNumRotationKeys)].mValue;
    }
    return {{position.x, position.y, position.z},
            glm::normalize(quat_xyzw(rotation.x, rotation.y, rotation.z, rotation.w))};
  }

  Assimp::Importer importer_;
  const aiScene* scene_;
};

/// Angle between two rotations, rad.
inline double angle_between(const Quat& a, const Quat& b) {
  return 2 * std::acos(std::min(1.0, std::abs(glm::dot(glm::normalize(a), glm::normalize(b)))));
}

}  // namespace limber::exporter::test
