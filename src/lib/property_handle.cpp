// PropertyHandle: finds the objects, and copies their values.
#include "lib/property_handle.h"

#include <array>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "properties/catalog.h"

namespace limber::lib {

Result<void> PropertyHandle::add(const Store& store, const PropertyRef& ref) {
  const std::string path = store.path(ref.node);
  if (ref.property == nullptr) return Error{fmt::format("{} is an object; append one of its properties", path)};
  const Property& property = *ref.property;
  const std::string address = fmt::format("{}/{}", path, property.name);
  if (property.width == 0)
    return Error{fmt::format("{} is {}; use limber_send()", address,
                             property.kind == PropertyKind::action ? "an action" : "a text")};
  if (property_ != nullptr && (table_ != &store.table(ref.node) || property_->index != property.index))
    return Error{
        fmt::format("{} and {} are different properties; use one handle for each", elements_.front().address, address)};
  property_ = &property;
  table_ = &store.table(ref.node);
  elements_.push_back({ref.node, address});
  return {};
}

Result<PropertyHandle> PropertyHandle::find(engine::Engine& engine, const std::string& address) {
  const Store& store = engine.store();
  PropertyHandle handle;
  handle.pattern_ = address;
  handle.structure_version_ = store.structure_version();
  handle.runs_ = engine.history().clears();
  const bool is_pattern = address.find_first_of("*?[{") != std::string::npos || address.find("//") != std::string::npos;
  std::vector<PropertyRef> found;
  if (is_pattern) {
    PatternBudget budget;
    Result<std::vector<PropertyRef>> matches = match_properties(store, address, budget);
    if (!matches) return Error{fmt::format("{}: {}", address, matches.error())};
    if (matches->empty()) return Error{fmt::format("{}: no property has an address of this pattern", address)};
    found = std::move(*matches);
  } else {
    const Result<PropertyRef> exact = find_property(store, address);
    if (!exact) return Error{exact.error()};
    found.push_back(*exact);
  }
  for (const PropertyRef& ref : found) {
    if (Result<void> added = handle.add(store, ref); !added) return Error{added.error()};
  }
  return handle;
}

Result<void> PropertyHandle::refresh(engine::Engine& engine) {
  if (structure_version_ == engine.store().structure_version() && runs_ == engine.history().clears()) return {};
  Result<PropertyHandle> found = find(engine, pattern_);
  if (!found) return Error{found.error()};
  if (found->count() != count() || found->width() != width())
    return Error{fmt::format("{}: the scene now has {} of these objects instead of {}; find the property again",
                             pattern_, found->count(), count())};
  property_ = found->property_;
  table_ = found->table_;
  structure_version_ = found->structure_version_;
  runs_ = found->runs_;
  for (std::size_t i = 0; i < elements_.size(); i++) {
    elements_[i].node = found->elements_[i].node;
    // equal texts stay where they are, because the program may use them (limber_address())
    if (elements_[i].address != found->elements_[i].address)
      elements_[i].address = std::move(found->elements_[i].address);
  }
  return {};
}

template <class T>
void PropertyHandle::read(const Store& store, T* out) const {
  std::array<double, 4> computed{};
  for (const Element& element : elements_) {
    const double* values = computed.data();
    if (property_->stored()) {
      values = store.values(element.node, *property_);
    } else {
      store.get(element.node, *property_, computed.data());
    }
    for (std::uint32_t i = 0; i < property_->width; i++) *out++ = static_cast<T>(values[i]);
  }
}

template <class T>
Result<void> PropertyHandle::write(Store& store, const T* values) {
  std::array<double, 4> value{};
  std::array<double, 4> accepted{};
  const auto copy = [&](std::size_t element) {
    for (std::uint32_t i = 0; i < property_->width; i++)
      value[i] = static_cast<double>(values[element * property_->width + i]);
    return std::span<const double>(value).first(property_->width);
  };
  for (std::size_t i = 0; i < elements_.size(); i++) {
    const Result<SetOutcome> valid = store.validate(elements_[i].node, *property_, copy(i), accepted.data());
    if (!valid) return Error{fmt::format("{}: {}", elements_[i].address, valid.error())};
  }
  for (std::size_t i = 0; i < elements_.size(); i++) {
    const Result<SetOutcome> set = store.set(elements_[i].node, *property_, copy(i));
    if (!set) return Error{fmt::format("{}: {}", elements_[i].address, set.error())};
  }
  return {};
}

template void PropertyHandle::read(const Store&, double*) const;
template void PropertyHandle::read(const Store&, float*) const;
template Result<void> PropertyHandle::write(Store&, const double*);
template Result<void> PropertyHandle::write(Store&, const float*);

}  // namespace limber::lib
