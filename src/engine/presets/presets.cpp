// Preset commands, and the application of presets to the world.
#include "engine/presets/presets.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/log/log.h"
#include "base/plural.h"
#include "base/text.h"
#include "engine/presets/routes.h"

namespace limber::engine {

namespace {

constexpr std::size_t kMaxRecent = 8;
constexpr const char* kScript = "script";

std::vector<std::string> excluded_patterns(const Blend& blend) {
  std::vector<std::string> all = blend.a->selection.except;
  if (blend.amount > 0) all.insert(all.end(), blend.b->selection.except.begin(), blend.b->selection.except.end());
  return all;
}

template <class T>
void push_recent(std::vector<T>& list, T item) {
  if (list.size() >= kMaxRecent) list.erase(list.begin());
  list.push_back(std::move(item));
}

std::string name_of(const Blend& blend) {
  if (blend.amount <= 0) return fmt::format("preset '{}'", printable(blend.a->name));
  return fmt::format("presets '{}' and '{}'", printable(blend.a->name), printable(blend.b->name));
}

// Returns the outcome of apply().
Outcome outcome_of(Result<std::string> notice) {
  if (!notice) return Outcome::rejected(notice.error());
  Outcome outcome;
  outcome.warning = std::move(*notice);
  return outcome;
}

std::string quoted_text(const Arg& arg) {
  return fmt::format("'{}'", arg.is_text() ? printable(shortened(arg.text, 100)) : number_text(arg.number));
}

// Arguments: name [word …]. Words: path patterns, behaviors, looks, all, poses, velocities; patterns after `except`
// are excluded from recalls.
struct StoreCommand {
  std::string name;
  std::optional<double> number;              // Number of an existing preset, instead of a name.
  std::optional<PresetSelection> selection;  // Nothing: the selection of the preset that is replaced, else all.
};

// Arguments: name|number [seconds [easing]]
struct RecallCommand {
  Arg preset;
  double seconds = 0;
  Easing easing = Easing::smooth;
};

// Arguments: name|number new_name
struct RenameCommand {
  Arg preset;
  std::string name;
};

// Arguments: name|number name|number amount
struct MorphCommand {
  Arg a, b;
  double amount = 0;  // 0 .. 1
};

std::optional<double> number_of(const Arg& arg) {
  if (arg.is_text()) return parse_number(arg.text);
  if (arg.kind == Arg::Kind::nil || !std::isfinite(arg.number)) return {};
  return arg.number;
}

bool is_preset_reference(const Arg& arg) {
  return arg.is_text() || (arg.kind == Arg::Kind::number && std::isfinite(arg.number));
}

// Parses one word after the name. False if the word is unknown.
bool parse_word(std::string_view word, bool& after_except, PresetSelection& selection) {
  std::vector<std::string>& patterns = after_except ? selection.except : selection.include;
  if (word.starts_with('/')) {
    patterns.emplace_back(word);
  } else if (same_name(word, "behaviors")) {
    patterns.insert(patterns.end(), {"/physics/body/*/behavior//*", "/physics/group//*"});
  } else if (same_name(word, "looks")) {
    patterns.emplace_back("/visuals//*");
  } else if (same_name(word, "poses")) {
    selection.poses = true;
  } else if (same_name(word, "velocities")) {
    selection.velocities = true;
  } else if (same_name(word, "except")) {
    after_except = true;
  } else {
    return same_name(word, "all");
  }
  return true;
}

Result<void> check_new_name(const std::string& name) {
  if (const auto fault = name_error(name)) return Error{fmt::format("invalid name: {}", *fault)};
  if (name == kScript) return Error{"'script' is reserved for the values of the scene; use another name"};
  return {};
}

Result<StoreCommand> parse_store(const Message& message) {
  const std::vector<Arg>& args = message.args;
  if (args.empty() || !is_preset_reference(args[0]))
    return Error{"expected a name, and optionally the properties to store"};
  StoreCommand command;
  if (args[0].is_text()) {
    command.name = args[0].text;
    if (const Result<void> valid = check_new_name(command.name); !valid) return Error{valid.error()};
  } else {
    command.number = args[0].number;
  }
  bool after_except = false;
  for (std::size_t i = 1; i < args.size(); i++) {
    if (!command.selection) command.selection.emplace();
    if (args[i].is_text() && parse_word(args[i].text, after_except, *command.selection)) continue;
    return Error{
        fmt::format("unknown word {}; expected path patterns, behaviors, looks, all, poses, velocities, except",
                    quoted_text(args[i]))};
  }
  return command;
}

Result<RecallCommand> parse_recall(const Message& message) {
  const std::vector<Arg>& args = message.args;
  if (args.empty() || args.size() > 3 || !is_preset_reference(args[0]))
    return Error{"expected a name or a number, optionally seconds and an easing: " + std::string(easing_names())};
  RecallCommand command{args[0], 0, Easing::smooth};
  if (args.size() > 1) {
    const std::optional<double> seconds = number_of(args[1]);
    if (!seconds || *seconds < 0 || *seconds > Presets::kMaxMorphSeconds)
      return Error{fmt::format("the duration must be 0 to {} s", Presets::kMaxMorphSeconds)};
    command.seconds = *seconds;
  }
  if (args.size() > 2) {
    const std::optional<Easing> easing = args[2].is_text() ? easing_of(args[2].text) : std::nullopt;
    if (!easing)
      return Error{fmt::format("unknown easing {}; expected one of: {}", quoted_text(args[2]), easing_names())};
    command.easing = *easing;
  }
  return command;
}

Result<RenameCommand> parse_rename(const Message& message) {
  const std::vector<Arg>& args = message.args;
  if (args.size() != 2 || !is_preset_reference(args[0]) || !args[1].is_text())
    return Error{"expected the name or the number of a preset, and its new name"};
  if (const Result<void> valid = check_new_name(args[1].text); !valid) return Error{valid.error()};
  return RenameCommand{args[0], args[1].text};
}

Result<MorphCommand> parse_morph(const Message& message) {
  const std::vector<Arg>& args = message.args;
  const std::optional<double> amount = args.size() == 3 ? number_of(args[2]) : std::nullopt;
  if (!amount || !is_preset_reference(args[0]) || !is_preset_reference(args[1]))
    return Error{"expected two presets and an amount from 0 to 1"};
  return MorphCommand{args[0], args[1], std::clamp(*amount, 0.0, 1.0)};
}

// Returns the presets that must exist for a command to succeed.
Result<std::vector<Arg>> referenced_presets(const Message& message) {
  if (message.address == "/preset/store") {
    const Result<StoreCommand> command = parse_store(message);
    if (!command) return Error{command.error()};
    return std::vector<Arg>{};
  }
  if (message.address == "/preset/recall") {
    const Result<RecallCommand> command = parse_recall(message);
    if (!command) return Error{command.error()};
    return std::vector<Arg>{command->preset};
  }
  if (message.address == "/preset/morph") {
    const Result<MorphCommand> command = parse_morph(message);
    if (!command) return Error{command.error()};
    return std::vector<Arg>{command->a, command->b};
  }
  if (message.address == "/preset/rename") {
    const Result<RenameCommand> command = parse_rename(message);
    if (!command) return Error{command.error()};
    return std::vector<Arg>{command->preset};
  }
  return message.args;
}

}  // namespace

Presets::Bank Presets::read(BackgroundWriter& writer, const std::string& path, PresetFile::WriteAccess access,
                            std::function<void(const std::string&)> on_failure) {
  Bank bank;
  if (path.empty()) return bank;
  std::error_code error;
  const std::filesystem::path canonical = std::filesystem::weakly_canonical(path, error);
  bank.file = error ? path : canonical.string();
  bank.saver = std::make_unique<PresetSaver>(writer, PresetFile(path, std::move(access)), std::move(on_failure));
  Result<ParsedPresets> read = bank.saver->load();
  if (!read) {
    log_error("{}; the file stays unchanged, and is backed up when a preset is stored", read.error());
    return bank;
  }
  for (const std::string& problem : read->problems) log_warning("{}", problem);
  bank.list = std::move(read->presets);
  return bank;
}

Presets::Bank Presets::open(Bank bank) { return bank.file == bank_.file ? std::move(bank) : exchange(std::move(bank)); }

Presets::Bank Presets::exchange(Bank bank) {
  std::swap(bank_, bank);
  pairs_.clear();
  update_names();
  return bank;
}

void Presets::save() {
  if (bank_.saver != nullptr && !saving_suspended_) bank_.saver->save(std::make_shared<const PresetList>(bank_.list));
}

void Presets::restore(const State& state) {
  set_list(state.list);
  morphs_ = state.morphs;
}

void Presets::set_list(PresetList list) {
  bank_.list = std::move(list);
  update_names();
}

void Presets::update_names() {
  names_.clear();
  for (const auto& preset : bank_.list) names_ += (names_.empty() ? "" : "\n") + preset->name;
}

void Presets::forget_store() {
  capturer_.forget_store();
  bindings_.clear();
  morphs_.clear();
}

void Presets::advance(sim::World& world) {
  if (!morphs_.empty()) morphs_.advance(world.store(), world.time());
}

Outcome Presets::execute(std::string_view command, const Message& message, sim::World& world) {
  if (command == "store") return store(message, world);
  if (command == "recall") return recall(message, world);
  if (command == "morph") return morph(message, world);
  if (command == "delete") return erase(message);
  if (command == "rename") return rename(message);
  return list_names(message);
}

const std::shared_ptr<const Preset>* Presets::find(std::string_view name) const {
  if (name == kScript) return script_ == nullptr ? nullptr : &script_;
  const auto at = std::find_if(bank_.list.begin(), bank_.list.end(), [&](const auto& p) { return p->name == name; });
  return at == bank_.list.end() ? nullptr : &*at;
}

Error Presets::not_found(std::string_view name) const {
  std::vector<std::string_view> names{kScript};
  for (const auto& preset : bank_.list) names.push_back(preset->name);
  return Error{fmt::format("there is no preset '{}'{}", printable(shortened(name, 100)), name_hint(name, names))};
}

Result<std::shared_ptr<const Preset>> Presets::resolve(const Arg& arg) const {
  if (arg.is_text()) {
    const auto* const found = find(arg.text);
    if (found == nullptr) return not_found(arg.text);
    return *found;
  }
  const double number = arg.number;
  if (arg.kind == Arg::Kind::nil || !(number >= 1 && number <= static_cast<double>(bank_.list.size())) ||
      number != std::floor(number))
    return not_found(arg.kind == Arg::Kind::nil ? "" : number_text(number));
  return bank_.list[static_cast<std::size_t>(number) - 1];
}

Result<Blend> Presets::blend_at(double number) {
  const auto count = static_cast<double>(bank_.list.size());
  if (!(number >= 1 && number <= count)) {
    return Error{bank_.list.empty()
                     ? std::string("there is no preset yet; /preset/store makes one")
                     : fmt::format("the number of a preset must be 1 to {}, got {}", bank_.list.size(), number)};
  }
  const auto index = static_cast<std::size_t>(number);
  const double part = number - std::floor(number);
  if (part <= 0) return Blend::of(bank_.list[index - 1]);
  return blend_of(bank_.list[index - 1], bank_.list[index], part);
}

Blend Presets::blend_of(const std::shared_ptr<const Preset>& a, const std::shared_ptr<const Preset>& b, double amount) {
  if (amount <= 0) return Blend::of(a);
  if (amount >= 1) return Blend::of(b);
  auto pair = std::find_if(pairs_.begin(), pairs_.end(), [&](const Pair& p) { return p.a == a && p.b == b; });
  if (pair == pairs_.end()) {
    push_recent(pairs_, Pair{a, b, align(a, b)});
    pair = pairs_.end() - 1;
  }
  Blend blend = pair->aligned;
  blend.amount = amount;
  return blend;
}

Outcome Presets::store(const Message& message, sim::World& world) {
  Result<StoreCommand> command = parse_store(message);
  if (!command) return Outcome::rejected(command.error());
  auto existing = bank_.list.end();
  if (command->number) {
    const auto at = resolve(Arg::of(*command->number));
    if (!at) return Outcome::rejected(at.error());
    existing = std::find(bank_.list.begin(), bank_.list.end(), *at);
    command->name = (*at)->name;
  } else {
    existing =
        std::find_if(bank_.list.begin(), bank_.list.end(), [&](const auto& p) { return p->name == command->name; });
  }
  if (existing == bank_.list.end() && bank_.list.size() >= kMax)
    return Outcome::rejected(fmt::format("there are {} presets already; delete one", kMax));
  // without words: the selection of the preset that is replaced
  const PresetSelection selection = command->selection             ? *command->selection
                                    : existing != bank_.list.end() ? (*existing)->selection
                                                                   : PresetSelection{};
  auto captured = capturer_.capture(world.store(), command->name, selection);
  if (!captured) return Outcome::rejected(captured.error());
  if (std::vector<PresetRoute> routes = routes_of(world, *(*captured)->schema); !routes.empty()) {
    auto with_routes = std::make_shared<Preset>(**captured);
    with_routes->routes = std::move(routes);
    *captured = std::move(with_routes);
  }
  if (existing == bank_.list.end()) {
    bank_.list.push_back(std::move(*captured));
  } else {
    *existing = std::move(*captured);
  }
  update_names();
  save();
  return {};
}

Outcome Presets::erase(const Message& message) {
  if (message.args.size() != 1) return Outcome::rejected("expected the name of a preset");
  const auto preset = resolve(message.args[0]);
  if (!preset) return Outcome::rejected(preset.error());
  if (*preset == script_) return Outcome::rejected("'script' has the values of the scene; it can't be deleted");
  std::erase(bank_.list, *preset);
  update_names();
  save();
  return {};
}

Outcome Presets::rename(const Message& message) {
  const Result<RenameCommand> command = parse_rename(message);
  if (!command) return Outcome::rejected(command.error());
  const auto preset = resolve(command->preset);
  if (!preset) return Outcome::rejected(preset.error());
  if (*preset == script_) return Outcome::rejected("'script' has the values of the scene; it can't be renamed");
  if ((*preset)->name == command->name) return {};
  if (find(command->name) != nullptr)
    return Outcome::rejected(fmt::format("there is a preset '{}' already; delete it first", printable(command->name)));
  auto renamed = std::make_shared<Preset>(**preset);
  renamed->name = command->name;
  *std::find(bank_.list.begin(), bank_.list.end(), *preset) = std::move(renamed);
  update_names();
  save();
  return {};
}

Outcome Presets::recall(const Message& message, sim::World& world) {
  const Result<RecallCommand> command = parse_recall(message);
  if (!command) return Outcome::rejected(command.error());
  Result<Blend> blend = Blend{};
  if (command->preset.is_text()) {
    const auto preset = resolve(command->preset);
    blend = preset ? Result<Blend>(Blend::of(*preset)) : Result<Blend>(Error{preset.error()});
  } else {
    blend = blend_at(command->preset.number);
  }
  if (!blend) return Outcome::rejected(blend.error());
  return outcome_of(apply(world, *blend, command->seconds, command->easing));
}

Result<void> Presets::recall_number(sim::World& world, double number, double seconds) {
  const Outcome outcome = recall({"/preset/recall", {Arg::of(number), Arg::of(seconds)}}, world);
  if (outcome.kind == Outcome::Kind::rejected) return Error{outcome.error};
  return {};
}

Outcome Presets::morph(const Message& message, sim::World& world) {
  const Result<MorphCommand> command = parse_morph(message);
  if (!command) return Outcome::rejected(command.error());
  const auto a = resolve(command->a);
  if (!a) return Outcome::rejected(a.error());
  const auto b = resolve(command->b);
  if (!b) return Outcome::rejected(b.error());
  return outcome_of(apply(world, blend_of(*a, *b, command->amount), 0, Easing::linear));
}

Outcome Presets::list_names(const Message& message) const {
  if (!message.args.empty()) return Outcome::rejected("takes no arguments");
  Outcome outcome;
  outcome.kind = Outcome::Kind::answered;
  Message& answer = outcome.answers.emplace_back(Message{"/list/presets", {}});
  for (const auto& preset : bank_.list) answer.args.push_back(Arg::of(preset->name));
  // a reply without arguments would look like a query
  if (bank_.list.empty()) answer.args.push_back(Arg::of(""));
  return outcome;
}

Result<std::shared_ptr<const PresetBinding>> Presets::bind(const Store& store, const Blend& blend) {
  std::erase_if(bindings_, [&](const auto& binding) { return !binding->up_to_date(store); });
  const std::vector<std::string> except = excluded_patterns(blend);
  for (const auto& binding : bindings_) {
    if (binding->schema() == blend.a->schema && binding->except() == except) return binding;
  }
  const bool all = blend.amount <= 0 && blend.a->selection.include.empty();
  auto created = PresetBinding::make(store, blend.a->schema, except, all);
  if (created) push_recent(bindings_, *created);
  return created;
}

// Applies a blend, at once or as a morph; returns a description of values that were skipped.
Result<std::string> Presets::apply(sim::World& world, const Blend& blend, double seconds, Easing easing) {
  Store& store = world.store();
  restore_routes(world, blend);
  const auto binding = bind(store, blend);
  if (!binding) return Error{fmt::format("{}: {}", name_of(blend), binding.error())};
  if (seconds > 0 && morphs_.full())
    return Error{fmt::format("{} morphs are running; wait for one to end, or send /preset/stop", Morphs::kMax)};
  // the newest command takes over the properties from older morphs
  morphs_.release(**binding);
  std::vector<std::string> notices{(*binding)->omissions(), missing_choices(store, **binding, blend)};
  if (seconds > 0) {
    Morph morph(store, **binding, blend, world.time(), seconds, easing);
    morph.announce(store);
    morphs_.begin(std::move(morph));
  } else {
    const RecallResult result = limber::engine::recall(store, **binding, blend);
    const std::size_t count = result.clamped + result.rejected;
    if (count > 0) {
      notices.push_back(
          fmt::format("{} clamped or rejected ({})", counted(count, "value was", "values were"), result.first_problem));
    }
  }
  overrides_.add_recall(blend);
  std::erase(notices, "");
  return notices.empty() ? std::string() : fmt::format("{}: {}", name_of(blend), fmt::join(notices, "; "));
}

void Presets::reapply(sim::World& world, const Blend& blend) {
  restore_routes(world, blend);
  const auto binding = bind(world.store(), blend);
  if (binding) (void)limber::engine::recall(world.store(), **binding, blend);
}

Result<void> Presets::check(const Message& message, std::span<const Message> before) const {
  const auto will_exist = [&](std::string_view name) {
    bool exists = find(name) != nullptr || name == kScript;
    for (const Message& m : before) {
      if (m.address == "/preset/rename" && m.args[1].text == name) exists = true;
      if (m.args.empty() || m.args[0].text != name) continue;
      if (m.address == "/preset/store") exists = true;
      if (m.address == "/preset/delete" || m.address == "/preset/rename") exists = false;
    }
    return exists;
  };
  const Result<std::vector<Arg>> presets = referenced_presets(message);
  if (!presets) return Error{presets.error()};
  for (const Arg& preset : *presets) {
    // numbers are resolved on execution
    if (preset.is_text() && !will_exist(preset.text)) return not_found(preset.text);
  }
  return {};
}

}  // namespace limber::engine
