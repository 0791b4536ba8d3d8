// Copies of blocks, and the views computed one by one.
#include "engine/image_maker.h"

#include <algorithm>
#include <utility>

namespace limber {

void ImageMaker::note(const Store& store, const Origin& origin, const Place& place, bool clamped) {
  // a slider that moves writes one place again and again
  constexpr std::ptrdiff_t kLookBack = 8;
  const auto near = notes_.end() - std::min(kLookBack, std::distance(notes_.begin(), notes_.end()));
  const auto same = std::find_if(near, notes_.end(), [&](const Noted& n) {
    return n.note.node == place.node && n.note.row == place.row && n.note.origin == origin;
  });
  if (same != notes_.end()) notes_.erase(same);
  if (notes_.size() >= kMostNotes) notes_.erase(notes_.begin(), notes_.begin() + kMostNotes / 4);
  Noted& noted = notes_.emplace_back();
  noted.made_then = made_;
  noted.note = {++noted_, origin, place.node, place.row, {}, clamped};
  store.get(place.node, *place.row, noted.note.values.data());
}

bool ImageMaker::make(const Store& store, const std::shared_ptr<const Snapshot>& snapshot, std::uint64_t asks) {
  if (asks == answered_) return false;
  if (now_() < next_) return false;
  const double begin = spent_();
  if (tree_ == nullptr || structure_ != store.structure_version()) {
    tree_ = std::make_shared<const Tree>(store);
    structure_ = store.structure_version();
  }
  std::erase_if(notes_, [&](const Noted& n) { return made_ >= n.made_then + kNoteLasts; });
  const std::shared_ptr<Image> image = out_.spare();
  image->number = ++made_;
  image->asks = answered_ = asks;
  image->tree = tree_;
  image->snapshot = snapshot;
  image->kept.assign(store.kept().begin(), store.kept().end());
  fill_computed(store, *image);
  image->notes.clear();
  for (const Noted& n : notes_) image->notes.push_back(n.note);
  out_.publish(image);
  const double cost = spent_() - begin;
  next_ = now_() + cost * (1 / kShare - 1);
  return true;
}

void ImageMaker::forget_store() {
  tree_ = nullptr;
  notes_.clear();
}

void ImageMaker::fill_computed(const Store& store, Image& image) const {
  image.views.resize(tree_->views_width());
  image.texts.resize(tree_->text_count());
  double* out = image.views.data();
  auto text = image.texts.begin();
  for (const Tree::Node& node : tree_->nodes()) {
    const void* const thing = store.thing(node.id);
    for (const Row& row : node.table->rows()) {
      if (row.type == RowType::text) *text++ = row.say(thing);
      if (!row.view()) continue;
      row.read(thing, out);
      out += row.width;
    }
  }
}

}  // namespace limber
