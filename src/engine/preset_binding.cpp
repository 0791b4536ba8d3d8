// Names to things, rows to rows.
#include "engine/preset_binding.h"

#include <algorithm>
#include <map>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/text.h"
#include "params/catalog.h"

namespace limber {

namespace {

bool same_kind(const PresetRow& row, const Row& live) {
  if (row.type == RowType::number) return live.type == RowType::number || live.type == RowType::integer;
  return row.type == live.type && row.width == live.width;
}

// "part, part and part", as far as it is worth reading
std::string some(const std::vector<std::string>& names, std::size_t count) {
  std::string text = fmt::format("{}", fmt::join(names, ", "));
  return count > names.size() ? text + " …" : text;
}

constexpr std::size_t kNamed = 3;

bool is_group(const Store& store, NodeId id) { return store.table(id).name() == "group" && !store.is_group(id); }

}  // namespace

class PresetBinding::Making {
 public:
  Making(const Store& store, PresetBinding& binding) : store_(store), b_(binding) {}

  Result<void> run(bool tells_of_all) {
    if (const Result<void> left = leave_alone(); !left) return left;
    const PresetShape& shape = *b_.shape_;
    std::vector<NodeId> ids(shape.things().size());
    ids[0] = store_.root();
    for (std::uint32_t i = 0; i < shape.things().size(); i++) {
      const PresetShape::Thing& thing = shape.things()[i];
      if (i != 0 && !ids[thing.parent].null()) ids[i] = store_.child(ids[thing.parent], shape.name(thing));
      if (shape.rows(thing) == nullptr) continue;
      if (ids[i].null()) {
        note(gone_, gone_count_, [&] { return shape.path(i); });
      } else {
        bind(ids[i], i);
      }
    }
    std::stable_partition(b_.things_.begin(), b_.things_.end(),
                          [&](const Thing& thing) { return is_group(store_, thing.id); });
    say(tells_of_all);
    return {};
  }

 private:
  template <class F>
  static void note(std::vector<std::string>& names, std::size_t& count, F&& name) {
    if (count++ < kNamed) names.push_back(name());
  }

  Result<void> leave_alone() {
    for (const std::string& pattern : b_.except_) {
      PatternBudget budget;
      const Result<std::vector<Place>> places = match_places(store_, pattern, budget);
      if (!places && (is_pattern(pattern) || pattern.find("//") != std::string::npos))
        return Error{fmt::format("except: {}", places.error())};
      if (!places) continue;  // a thing that is gone needs no leaving alone
      for (const Place& place : *places) {
        if (place.row == nullptr) {
          store_.walk(place.node, [&](NodeId id) { left_alone_[id.slot] = ~std::uint64_t{0}; });
        } else {
          left_alone_[place.node.slot] |= std::uint64_t{1} << place.row->index;
        }
      }
    }
    return {};
  }

  void bind(NodeId id, std::uint32_t number) {
    const PresetShape::Thing& thing = b_.shape_->things()[number];
    const Table& table = store_.table(id);
    const std::uint32_t fit = fit_of(*b_.shape_->rows(thing), table);
    const Fit& made = b_.fits_[fit];
    if (made.misfits > 0) {
      note(misfits_, misfit_count_, [&] { return b_.shape_->path(number) + "/" + made.misfit; });
      misfit_count_ += made.misfits - 1;
    }
    const auto left = left_alone_.find(id.slot);
    const std::uint64_t alone = left == left_alone_.end() ? 0 : left->second;
    b_.things_.push_back({id, number, fit, thing.at, alone});
  }

  std::uint32_t fit_of(const PresetClass& rows, const Table& table) {
    const auto [known, fresh] = known_.try_emplace({&rows, &table}, static_cast<std::uint32_t>(b_.fits_.size()));
    if (!fresh) return known->second;
    Fit fit{&rows, &table, {}, {}, {}, 0};
    for (std::size_t i = 0; i < rows.rows.size(); i++) {
      const PresetRow& row = rows.rows[i];
      const Row* const live = table.find(row.name);
      if (live == nullptr || !live->writable() || !live->stored() || !same_kind(row, *live)) {
        if (fit.misfits++ == 0) fit.misfit = row.name;
        continue;
      }
      FitRow& made = fit.rows.emplace_back(FitRow{live, &row, rows.offsets[i], {}});
      for (const std::string& label : row.labels) {
        const auto at = std::find_if(live->choices.begin(), live->choices.end(),
                                     [&](const std::string& choice) { return same_name(choice, label); });
        made.choices.push_back(at == live->choices.end() ? -1 : static_cast<double>(at - live->choices.begin()));
      }
      if (std::ranges::find(made.choices, -1) != made.choices.end())
        fit.poorer.push_back(static_cast<std::uint32_t>(fit.rows.size() - 1));
    }
    b_.fits_.push_back(std::move(fit));
    return known->second;
  }

  // properties that the world has and a preset of all of them does not
  std::size_t newcomers() {
    std::unordered_map<const Table*, std::size_t> counts;
    std::size_t all = 0;
    std::size_t statics = 0;
    store_.walk(store_.root(), [&](NodeId id) {
      const Table& table = store_.table(id);
      const auto [known, fresh] = counts.try_emplace(&table, 0);
      if (fresh) {
        known->second = static_cast<std::size_t>(std::ranges::count_if(
            table.rows(), [](const Row& row) { return row.kind == RowKind::property && row.stored(); }));
      }
      all += known->second;
      for (const Row& row : table.rows()) {
        if (row.kind == RowKind::property && row.refuse != nullptr)
          statics += row.refuse(store_.thing(id), store_.values(id, row)) ? 0 : 1;
      }
    });
    std::size_t properties = 0;
    for (const Thing& thing : b_.things_) {
      for (const FitRow& row : b_.fits_[thing.fit].rows) properties += row.row->kind == RowKind::property ? 1 : 0;
    }
    all -= std::min(all, statics);
    return all - std::min(all, properties);
  }

  void say(bool tells_of_all) {
    std::vector<std::string> texts;
    if (gone_count_ > 0)
      texts.push_back(fmt::format("{} thing{} gone ({})", gone_count_, gone_count_ == 1 ? " is" : "s are",
                                  some(gone_, gone_count_)));
    if (misfit_count_ > 0)
      texts.push_back(fmt::format("{} row{} no longer there or of another type ({})", misfit_count_,
                                  misfit_count_ == 1 ? " is" : "s are", some(misfits_, misfit_count_)));
    const std::size_t came = tells_of_all ? newcomers() : 0;
    if (came > 0)
      texts.push_back(fmt::format("{} came since and {}", came == 1 ? "1 value" : fmt::format("{} values", came),
                                  came == 1 ? "stays as it is" : "stay as they are"));
    b_.left_out_ = fmt::format("{}", fmt::join(texts, "; "));
  }

  const Store& store_;
  PresetBinding& b_;
  std::unordered_map<std::uint32_t, std::uint64_t> left_alone_;  // by slot
  std::map<std::pair<const PresetClass*, const Table*>, std::uint32_t> known_;
  std::vector<std::string> gone_, misfits_;
  std::size_t gone_count_ = 0;
  std::size_t misfit_count_ = 0;
};

Result<std::shared_ptr<const PresetBinding>> PresetBinding::make(const Store& store,
                                                                 std::shared_ptr<const PresetShape> shape,
                                                                 std::span<const std::string> except,
                                                                 bool tells_of_all) {
  auto binding = std::make_shared<PresetBinding>();
  binding->structure_ = store.structure_version();
  binding->shape_ = std::move(shape);
  binding->except_.assign(except.begin(), except.end());
  if (const Result<void> made = Making(store, *binding).run(tells_of_all); !made) return Error{made.error()};
  return std::shared_ptr<const PresetBinding>(std::move(binding));
}

bool PresetBinding::read(const FitRow& row, const double* values, double* out) {
  const double* const from = values + row.at;
  if (row.row->type != RowType::choice) {
    std::copy_n(from, row.row->width, out);
    return true;
  }
  out[0] = row.choices[static_cast<std::size_t>(from[0])];
  return out[0] >= 0;
}

}  // namespace limber
