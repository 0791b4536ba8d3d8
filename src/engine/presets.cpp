// Messages to presets, presets to the world.
#include "engine/presets.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/log.h"
#include "base/text.h"
#include "engine/preset_words.h"
#include "engine/recall.h"

namespace limber {

namespace {

constexpr std::size_t kLately = 8;
constexpr const char* kScript = "script";

std::vector<std::string> excepts(const Blend& blend) {
  std::vector<std::string> all = blend.a->choice.except;
  if (blend.amount > 0) all.insert(all.end(), blend.b->choice.except.begin(), blend.b->choice.except.end());
  return all;
}

template <class T>
void keep_lately(std::vector<T>& list, T item) {
  if (list.size() >= kLately) list.erase(list.begin());
  list.push_back(std::move(item));
}

std::string name_of(const Blend& blend) {
  if (blend.amount <= 0) return fmt::format("preset '{}'", printable(blend.a->name));
  return fmt::format("presets '{}' and '{}'", printable(blend.a->name), printable(blend.b->name));
}

}  // namespace

Presets::Book Presets::read(const std::string& scene, PresetFile::Owner owner,
                            std::function<void(const std::string&)> failed) {
  Book book;
  if (scene.empty()) return book;
  const std::string path = PresetFile::beside(scene);
  std::error_code none;
  const std::filesystem::path whole = std::filesystem::weakly_canonical(path, none);
  book.file = none ? path : whole.string();
  book.keeper = std::make_unique<PresetKeeper>(PresetFile(path, std::move(owner)), std::move(failed));
  Result<PresetsRead> read = book.keeper->load();
  if (!read) {
    log_error("{}; it stays as it is, and is set aside when a preset is stored", read.error());
    return book;
  }
  for (const std::string& problem : read->problems) log_warning("{}", problem);
  book.list = std::move(read->presets);
  return book;
}

Presets::Book Presets::open(Book book) { return book.file == file_ ? std::move(book) : exchange(std::move(book)); }

Presets::Book Presets::exchange(Book book) {
  std::swap(list_, book.list);
  std::swap(keeper_, book.keeper);
  std::swap(file_, book.file);
  pairs_.clear();
  changed();
  return book;
}

void Presets::save() {
  if (keeper_ != nullptr && !again_) keeper_->save(std::make_shared<const PresetList>(list_));
}

void Presets::bring_back(const Memory& memory) {
  take_list(memory.list);
  morphs_ = memory.morphs;
}

void Presets::take_list(PresetList list) {
  list_ = std::move(list);
  changed();
}

void Presets::changed() {
  names_.clear();
  for (const auto& preset : list_) names_ += (names_.empty() ? "" : "\n") + preset->name;
}

void Presets::forget_store() {
  taker_.forget_store();
  bindings_.clear();
  morphs_.clear();
}

void Presets::finish_saving() {
  if (keeper_ != nullptr) keeper_->finish();
}

void Presets::advance(World& world) {
  if (!morphs_.empty()) morphs_.advance(world.store(), world.time());
}

Outcome Presets::execute(std::string_view what, const Message& message, World& world) {
  if (what == "store") return store(message, world);
  if (what == "recall") return recall(message, world);
  if (what == "morph") return morph(message, world);
  if (what == "delete") return erase(message);
  return names_asked(message);
}

const std::shared_ptr<const Preset>* Presets::find(std::string_view name) const {
  if (name == kScript) return script_ == nullptr ? nullptr : &script_;
  const auto at = std::find_if(list_.begin(), list_.end(), [&](const auto& p) { return p->name == name; });
  return at == list_.end() ? nullptr : &*at;
}

Error Presets::unknown(std::string_view name) const {
  std::vector<std::string_view> names{kScript};
  for (const auto& preset : list_) names.push_back(preset->name);
  return Error{fmt::format("there is no preset '{}'{}", printable(shortened(name, 100)), name_hint(name, names))};
}

Result<std::shared_ptr<const Preset>> Presets::named(const Arg& arg) const {
  if (arg.is_text()) {
    const auto* const found = find(arg.text);
    if (found == nullptr) return unknown(arg.text);
    return *found;
  }
  const double number = arg.number;
  if (arg.kind == Arg::Kind::nil || !(number >= 1 && number <= static_cast<double>(list_.size())) ||
      number != std::floor(number))
    return unknown(arg.kind == Arg::Kind::nil ? "" : number_text(number));
  return list_[static_cast<std::size_t>(number) - 1];
}

Result<Blend> Presets::at_number(double number) {
  const auto count = static_cast<double>(list_.size());
  if (!(number >= 1 && number <= count)) {
    return Error{list_.empty() ? std::string("there is no preset yet; /preset/store makes one")
                               : fmt::format("presets have the numbers 1 .. {}; {} is none", list_.size(), number)};
  }
  const auto below = static_cast<std::size_t>(number);
  const double part = number - std::floor(number);
  if (part <= 0) return Blend::of(list_[below - 1]);
  return between(list_[below - 1], list_[below], part);
}

Blend Presets::between(const std::shared_ptr<const Preset>& a, const std::shared_ptr<const Preset>& b, double amount) {
  if (amount <= 0) return Blend::of(a);
  if (amount >= 1) return Blend::of(b);
  auto known = std::find_if(pairs_.begin(), pairs_.end(), [&](const Pair& p) { return p.a == a && p.b == b; });
  if (known == pairs_.end()) {
    keep_lately(pairs_, Pair{a, b, aligned(a, b)});
    known = pairs_.end() - 1;
  }
  Blend blend = known->aligned;
  blend.amount = amount;
  return blend;
}

Outcome Presets::store(const Message& message, World& world) {
  Result<StoreWish> wish = store_wish(message);
  if (!wish) return Outcome::refused(wish.error());
  auto place = list_.end();
  if (wish->number) {
    const auto at = named(Arg::of(*wish->number));
    if (!at) return Outcome::refused(at.error());
    place = std::find(list_.begin(), list_.end(), *at);
    wish->name = (*at)->name;
  } else {
    place = std::find_if(list_.begin(), list_.end(), [&](const auto& p) { return p->name == wish->name; });
  }
  if (place == list_.end() && list_.size() >= kMost)
    return Outcome::refused(fmt::format("there are {} presets already; delete one", kMost));
  // without words it is made of what it was made of before
  const PresetChoice choice = wish->choice ? *wish->choice : place != list_.end() ? (*place)->choice : PresetChoice{};
  auto taken = taker_.take(world.store(), wish->name, choice);
  if (!taken) return Outcome::refused(taken.error());
  if (place == list_.end()) {
    list_.push_back(std::move(*taken));
  } else {
    *place = std::move(*taken);
  }
  changed();
  save();
  return {};
}

Outcome Presets::erase(const Message& message) {
  if (message.args.size() != 1) return Outcome::refused("takes the name of a preset");
  const auto preset = named(message.args[0]);
  if (!preset) return Outcome::refused(preset.error());
  if (*preset == script_) return Outcome::refused("'script' is what the scene describes; it can't be deleted");
  std::erase(list_, *preset);
  changed();
  save();
  return {};
}

Outcome Presets::recall(const Message& message, World& world) {
  const Result<RecallWish> wish = recall_wish(message);
  if (!wish) return Outcome::refused(wish.error());
  Result<Blend> blend = Blend{};
  if (wish->which.is_text()) {
    const auto preset = named(wish->which);
    blend = preset ? Result<Blend>(Blend::of(*preset)) : Result<Blend>(Error{preset.error()});
  } else {
    blend = at_number(wish->which.number);
  }
  if (!blend) return Outcome::refused(blend.error());
  Result<std::string> said = go(world, *blend, wish->seconds, wish->easing);
  if (!said) return Outcome::refused(said.error());
  Outcome outcome;
  outcome.said = std::move(*said);
  return outcome;
}

Result<void> Presets::recall_number(World& world, double number, double seconds) {
  const Outcome outcome = recall({"/preset/recall", {Arg::of(number), Arg::of(seconds)}}, world);
  if (outcome.kind == Outcome::Kind::refused) return Error{outcome.error};
  return {};
}

Outcome Presets::morph(const Message& message, World& world) {
  const Result<MorphWish> wish = morph_wish(message);
  if (!wish) return Outcome::refused(wish.error());
  const auto a = named(wish->a);
  if (!a) return Outcome::refused(a.error());
  const auto b = named(wish->b);
  if (!b) return Outcome::refused(b.error());
  Result<std::string> said = go(world, between(*a, *b, wish->amount), 0, Easing::linear);
  if (!said) return Outcome::refused(said.error());
  Outcome outcome;
  outcome.said = std::move(*said);
  return outcome;
}

Outcome Presets::names_asked(const Message& message) const {
  if (!message.args.empty()) return Outcome::refused("takes no arguments");
  Outcome outcome;
  outcome.kind = Outcome::Kind::answered;
  Message& answer = outcome.answers.emplace_back(Message{"/list/presets", {}});
  for (const auto& preset : list_) answer.args.push_back(Arg::of(preset->name));
  // no answer looks like a question
  if (list_.empty()) answer.args.push_back(Arg::of(""));
  return outcome;
}

Result<std::shared_ptr<const PresetBinding>> Presets::bind(const Store& store, const Blend& blend) {
  std::erase_if(bindings_, [&](const auto& binding) { return !binding->holds(store); });
  const std::vector<std::string> except = excepts(blend);
  for (const auto& binding : bindings_) {
    if (binding->shape() == blend.a->shape && binding->except() == except) return binding;
  }
  const bool all = blend.amount <= 0 && blend.a->choice.rows.empty();
  auto made = PresetBinding::make(store, blend.a->shape, except, all);
  if (made) keep_lately(bindings_, *made);
  return made;
}

// at once or on its way; the answer: what was left out
Result<std::string> Presets::go(World& world, const Blend& blend, double seconds, Easing easing) {
  Store& store = world.store();
  const auto binding = bind(store, blend);
  if (!binding) return Error{fmt::format("{}: {}", name_of(blend), binding.error())};
  if (seconds > 0 && morphs_.full())
    return Error{fmt::format("{} morphs run already; wait for one, or /preset/stop", Morphs::kMost)};
  // the newest hand has the rows that it reaches
  morphs_.release(**binding);
  std::vector<std::string> said{(*binding)->left_out(), lost_choices(store, **binding, blend)};
  if (seconds > 0) {
    Morph morph(store, **binding, blend, world.time(), seconds, easing);
    morph.announce(store);
    morphs_.begin(std::move(morph));
  } else {
    const Recalled told = limber::recall(store, **binding, blend);
    const std::size_t count = told.clamped + told.refused;
    if (count > 0) {
      said.push_back(fmt::format("{} value{} not taken as {} ({})", count, count == 1 ? " was" : "s were",
                                 count == 1 ? "it is" : "they are", told.first));
    }
  }
  hand_.recall(blend);
  std::erase(said, "");
  return said.empty() ? std::string() : fmt::format("{}: {}", name_of(blend), fmt::join(said, "; "));
}

void Presets::repeat(World& world, const Blend& blend) {
  const auto binding = bind(world.store(), blend);
  if (binding) (void)limber::recall(world.store(), **binding, blend);
}

Result<void> Presets::check(const Message& message, std::span<const Message> before) const {
  const auto will_be = [&](const Arg& arg) {
    if (!arg.is_text()) return true;  // which number is which is known then
    bool there = find(arg.text) != nullptr || arg.text == kScript;
    for (const Message& m : before) {
      if (m.args.empty() || m.args[0].text != arg.text) continue;
      if (m.address == "/preset/store") there = true;
      if (m.address == "/preset/delete") there = false;
    }
    return there;
  };
  std::vector<Arg> names;
  if (message.address == "/preset/store") {
    const Result<StoreWish> wish = store_wish(message);
    return wish ? Result<void>() : Result<void>(Error{wish.error()});
  }
  if (message.address == "/preset/recall") {
    const Result<RecallWish> wish = recall_wish(message);
    if (!wish) return Error{wish.error()};
    names = {wish->which};
  } else if (message.address == "/preset/morph") {
    const Result<MorphWish> wish = morph_wish(message);
    if (!wish) return Error{wish.error()};
    names = {wish->a, wish->b};
  } else {
    names = message.args;
  }
  for (const Arg& name : names) {
    if (!will_be(name)) return unknown(name.text);
  }
  return {};
}

}  // namespace limber
