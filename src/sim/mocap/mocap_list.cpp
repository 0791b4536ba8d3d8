// MocapList: adding sources, and passing messages to them.
#include "sim/mocap/mocap_list.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/log/log.h"
#include "base/memory/archive.h"
#include "properties/values_hash.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

constexpr std::size_t kMaxSources = 64;
constexpr std::string_view kVmcPrefix = "/VMC/Ext/";

}  // namespace

Result<MocapSource*> MocapList::add(std::string name, std::shared_ptr<const MocapSetup> setup) {
  Store& store = world_.store();
  const auto fault = [&](std::string_view problem) { return Error{fmt::format("mocap '{}': {}", name, problem)}; };
  if (sources_) {
    if (const Result<void> free = sources_->check_new_name("mocap source", name); !free) return Error{free.error()};
  } else if (const auto wrong = name_error(name)) {
    return Error{fmt::format("mocap source: {}", *wrong)};
  }
  if (list().size() == kMaxSources) return fault(fmt::format("there are {} sources already", kMaxSources));
  if (const Result<void> valid = MocapSource::check(*setup); !valid) return fault(valid.error());
  if (const Result<void> free = check_addresses(*setup); !free) return fault(free.error());
  if (!sources_) {
    sources_.emplace(store, store.add_group(store.parent(world_.id()), "mocap"));
    world_.transaction().record([](void* self, std::size_t) { static_cast<MocapList*>(self)->clear(); }, this);
  }
  MocapSource& source =
      sources_->add(std::make_unique<MocapSource>(world_, sources_->group(), std::move(name), std::move(setup)));
  index_addresses();
  world_.transaction().record(
      [](void* self, std::size_t) {
        MocapList& of = *static_cast<MocapList*>(self);
        of.sources_->objects().pop_back();
        of.index_addresses();
      },
      this);
  return &source;
}

Result<void> MocapList::check_addresses(const MocapSetup& setup) const {
  for (const MocapMapping& mapping : setup.messages) {
    for (const auto& source : list()) {
      const auto same = [&](const MocapMessage& message) { return message.address() == mapping.address; };
      if (std::ranges::any_of(source->messages(), same))
        return Error{fmt::format("mocap '{}' receives {} already; give each source a dancer or messages of its own",
                                 source->name(), mapping.address)};
    }
  }
  return {};
}

void MocapList::index_addresses() {
  receivers_.clear();
  patterns_.clear();
  vmc_ = nullptr;
  for (const auto& source : list()) {
    const std::span<const MocapMessage> messages = source->messages();
    for (std::size_t i = 0; i < messages.size(); i++) {
      if (messages[i].names_joint_in_address()) {
        patterns_.push_back({source.get(), i});
      } else {
        receivers_[messages[i].address()] = {source.get(), i};
      }
    }
    if (source->setup()->is_vmc) vmc_ = source.get();
  }
}

void MocapList::remove(const MocapSource& source) {
  const std::size_t index = sources_->index_of(source);
  if (index == list().size()) return;
  sources_->objects().erase(sources_->objects().begin() + static_cast<std::ptrdiff_t>(index));
  index_addresses();
}

void MocapList::move_to_front(const std::vector<MocapSource*>& first) {
  if (sources_) sources_->move_to_front(first);
}

void MocapList::clear() {
  if (!sources_) return;
  const NodeId group = sources_->group();
  sources_.reset();
  world_.store().remove(group);
  index_addresses();
}

std::optional<Result<void>> MocapList::accept(const Message& message) {
  if (list().empty()) return std::nullopt;
  if (const auto found = receivers_.find(message.address); found != receivers_.end())
    return found->second.source->accept(found->second.mapping, message.args, {});
  for (const Receiver& receiver : patterns_) {
    const std::string_view joint = receiver.source->messages()[receiver.mapping].joint_in(message.address);
    if (!joint.empty()) return receiver.source->accept(receiver.mapping, message.args, joint);
  }
  // the other messages of this protocol: blend shapes, cameras, devices
  if (vmc_ != nullptr && message.address.starts_with(kVmcPrefix)) return Result<void>();
  return std::nullopt;
}

void MocapList::step(double dt) {
  for (const auto& source : list()) source->step(dt);
  for (std::size_t i = 0; i < list().size(); i++) {
    for (std::size_t k = i + 1; k < list().size(); k++) {
      if (list()[i]->consume_swap(*list()[k]))
        log_warning("mocap '{}' and '{}': each is where the other one was; the tracking system may have mixed them up",
                    list()[i]->name(), list()[k]->name());
    }
  }
}

std::uint64_t MocapList::state_hash(std::uint64_t start) const {
  const Store& store = world_.store();
  for (const auto& source : list()) {
    NumberHash numbers(hash_bytes(source->name(), start));
    numbers.add_word(node_hash(store, source->id()));
    for (const auto& joint : source->joints()) numbers.add_word(node_hash(store, joint->id()));
    start = numbers.value();
  }
  return start;
}

void MocapList::serialize(Archive& archive) {
  for (const auto& source : list()) source->serialize(archive);
}

}  // namespace limber::sim
