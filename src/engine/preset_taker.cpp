// Plans are kept; along one for a preset.
#include "engine/preset_taker.h"

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

#include "base/address_space.h"
#include "base/system/thread.h"
#include "base/system/virtual_memory.h"
#include "params/catalog.h"

namespace limber {

namespace {

constexpr std::size_t kMostPlans = 8;
// What comes takes far more of its tick than a look at it: where this part of all came or went, all is looked at.
constexpr std::uint64_t kMuch = 8;

// many megabytes that are touched for the first time would be a fault in every page; without large pages it works too
void ask_for_large_pages(const std::vector<double>& room) {
  constexpr std::size_t kLarge = std::size_t{4} << 20u;
  const std::size_t bytes = room.capacity() * sizeof(double);
  if (bytes < kLarge) return;
  const std::size_t page = system::page_size();
  auto* const first = const_cast<std::byte*>(reinterpret_cast<const std::byte*>(room.data()));
  system::prefer_large_pages(next_page(first, page), bytes - page);
}

}  // namespace

PresetTaker::PresetTaker() = default;
PresetTaker::~PresetTaker() = default;

void PresetTaker::forget_store() {
  every_.reset();
  choices_.clear();
  before_.reset();
  ahead_.reset();
  quiet_ = 0;
}

// plans hold as long as nothing comes or goes
void PresetTaker::follow(const Store& store) {
  if (structure_ == store.structure_version()) return;
  structure_ = store.structure_version();
  ahead_.reset();
  quiet_ = 0;
  if (every_) before_ = std::move(every_);
  every_.reset();
  choices_.clear();
}

// What is touched for the first time is a fault in every page, which take longer than the copy: beside the show.
void PresetTaker::make_room(const Store& store) {
  const std::size_t numbers = store.kept().size();
  if (numbers < kRoomWorth) return;
  if (making_room_.valid()) {
    if (making_room_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    room_ = making_room_.get();
  }
  if (room_.size() >= numbers) return;
  try {
    making_room_ = std::async(std::launch::async, [count = numbers + numbers / 8] {
      system::name_this_thread("limber-room");
      std::vector<double> room;
      room.reserve(count);
      ask_for_large_pages(room);
      room.resize(count);
      return room;
    });
  } catch (const std::system_error&) {
    // no thread is to be had: the copy will take longer
  }
}

void PresetTaker::prepare(const Store& store) {
  const std::uint64_t changes = store.structure_version() - structure_;
  follow(store);
  make_room(store);
  if (changes * kMuch >= store.view()->slot_count) return make_ready(store);
  if (quiet_ <= kQuiet) quiet_++;
  if (quiet_ <= kQuiet || every_) return;
  plan_ahead(store, kSlice);
}

void PresetTaker::plan_ahead(const Store& store, std::size_t things) {
  if (ahead_ == nullptr) ahead_ = std::make_unique<PresetPlanning>(store, before_ ? &*before_ : nullptr);
  if (!ahead_->go(things)) return;
  every_ = ahead_->finish();
  ahead_.reset();
}

const PresetPlan& PresetTaker::every(const Store& store) {
  follow(store);
  if (!every_) plan_ahead(store, SIZE_MAX);
  return *every_;
}

// it stays until the next is asked for
Result<const PresetPlan*> PresetTaker::plan_for(const Store& store, const PresetChoice& choice) {
  const PresetPlan& all = every(store);
  if (choice == PresetChoice{}) return &all;
  const auto known = std::ranges::find(choices_, choice, &PresetPlan::choice);
  if (known != choices_.end()) return &*known;
  Result<PresetPlan> made = PresetPlan::of_choice(store, all, choice);
  if (!made) return Error{made.error()};
  if (choices_.size() >= kMostPlans) choices_.erase(choices_.begin());
  return &choices_.emplace_back(std::move(*made));
}

Result<std::shared_ptr<const Preset>> PresetTaker::take(const Store& store, std::string name,
                                                        const PresetChoice& choice) {
  const Result<const PresetPlan*> plan = plan_for(store, choice);
  if (!plan) return Error{plan.error()};
  // what is much smaller is not worth all of the room
  std::vector<double> room;
  if ((*plan)->shape->width() > room_.size() / 2) room.swap(room_);
  return copy(store, **plan, std::move(name), std::move(room));
}

std::shared_ptr<const Preset> PresetTaker::copy(const Store& store, const PresetPlan& plan, std::string name,
                                                std::vector<double> room) {
  room.clear();
  auto preset = std::make_shared<Preset>(Preset{std::move(name), plan.choice, plan.shape, std::move(room)});
  preset->values.reserve(plan.shape->width());
  ask_for_large_pages(preset->values);
  for (const PresetPlan::Piece& piece : plan.pieces) {
    const double* const from = (piece.live ? store.live() : store.kept()).data() + piece.from;
    preset->values.insert(preset->values.end(), from, from + piece.count);
  }
  return preset;
}

std::shared_ptr<const Preset> PresetTaker::take_script(const Store& store) {
  auto preset = std::make_shared<Preset>(*copy(store, PresetPlanning::make(store, nullptr), "script", {}));
  const Result<Place> scene = find_place(store, "/scene", false);
  if (!scene || scene->row != nullptr) return preset;
  const Table& table = store.table(scene->node);
  for (const PresetShape::Thing& thing : preset->shape->things()) {
    const PresetClass* const rows = preset->shape->rows(thing);
    if (rows == nullptr || thing.parent != 0 || preset->shape->name(thing) != "scene") continue;
    for (std::size_t i = 0; i < rows->rows.size(); i++) {
      const Row& row = table.at(rows->rows[i].name);
      std::copy_n(row.initial.begin(), row.width, preset->values.begin() + thing.at + rows->offsets[i]);
    }
  }
  return preset;
}

}  // namespace limber
