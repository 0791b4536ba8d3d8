// PropertyHandle: a property of one or more objects, read and written as an array.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "engine/engine.h"
#include "lib/limber.h"

namespace limber::lib {

class PropertyHandle {
 public:
  /// Finds the objects. Errors: no such property, not the same property for all, an action, a text.
  static Result<PropertyHandle> find(engine::Engine& engine, const std::string& address);

  std::size_t count() const { return elements_.size(); }
  std::size_t width() const { return property_->width; }
  std::size_t size() const { return count() * width(); }
  const std::string& address(std::size_t index) const { return elements_[index].address; }
  const Property& property() const { return *property_; }

  /// Finds the objects again if the scene has run again or its objects have changed. Error, and count() and width() are
  /// unchanged: their number has changed.
  Result<void> refresh(engine::Engine& engine);
  /// Copies the values to `out`, which has size() numbers. Requires refresh().
  template <class T>
  void read(const Store& store, T* out) const;
  /// Sets the values. On error nothing is set. Requires refresh().
  template <class T>
  Result<void> write(Store& store, const T* values);

 private:
  struct Element {
    NodeId node;
    std::string address;
  };

  Result<void> add(const Store& store, const PropertyRef& ref);

  std::string pattern_;
  const Property* property_ = nullptr;
  const PropertyTable* table_ = nullptr;
  std::vector<Element> elements_;
  std::uint64_t structure_version_ = 0;
  std::uint64_t runs_ = 0;  // History::clears()
};

}  // namespace limber::lib

struct limber_property {
  limber_sim* owner = nullptr;
  limber::lib::PropertyHandle handle;
};
