// MjcfReader: attributes of MJCF elements with the defaults of their class. Reports invalid values with their line, the
// value in the file, and a fix. Internal to the module: only src/model includes it.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/vec.h"
#include "model/mjcf/document.h"
#include "model/mjcf/file.h"
#include "model/problems.h"

namespace limber::model {

/// The class that applies to an element: an index into the reader's list; 0 is the main class.
using MjcfClass = std::size_t;

class MjcfReader {
 public:
  MjcfReader(const MjcfDocument& document, Problems& problems) : document_(document), problems_(problems) {}

  /// Reads all <default> elements below the root.
  void read_defaults();
  /// The class that the element names with `attribute`, else `inherited`; reports an unknown name.
  MjcfClass class_of(const MjcfElement& element, MjcfClass inherited, const char* attribute = "class");

  /// The text of an attribute, of the element itself or of its class; null if neither has it.
  const std::string* text(const MjcfElement& element, MjcfClass cls, std::string_view attribute) const;
  /// The text of an attribute in the defaults of a kind of element; null if there is none.
  const std::string* default_text(std::string_view tag, MjcfClass cls, std::string_view attribute) const;
  /// The numbers of an attribute: empty if it is absent, or invalid (which is reported).
  std::vector<double> numbers(const MjcfElement& element, MjcfClass cls, const char* attribute, std::size_t min_count,
                              std::size_t max_count);
  double number(const MjcfElement& element, MjcfClass cls, const char* attribute, double fallback);
  std::optional<Vec3> vector(const MjcfElement& element, MjcfClass cls, const char* attribute);
  /// true, false, or empty for `auto`, absent or invalid (which is reported).
  std::optional<bool> flag(const MjcfElement& element, MjcfClass cls, const char* attribute);
  /// Whether a range applies: the flag `attribute`, or if it is `auto`, that `range` is present.
  bool limited(const MjcfElement& element, MjcfClass cls, const char* attribute, const char* range);
  /// The position and orientation of an element.
  Pose pose(const MjcfElement& element, MjcfClass cls);
  Quat rotation(const MjcfElement& element, MjcfClass cls);
  /// A name that the file gives, if it is usable (else it is reported); empty if there is none.
  std::string name(const MjcfElement& element);

  void error(const MjcfElement& element, const std::string& text, const std::string& fix);
  void warning(const MjcfElement& element, const std::string& text, const std::string& fix);
  void note(const MjcfElement& element, const std::string& text, const std::string& fix);
  /// Counts an effect that is not supported; report_deferred() reports each once, with the number of places.
  void unsupported(const MjcfElement& element, const std::string& text, const std::string& fix,
                   Severity severity = Severity::note);
  /// Reports an element with an unknown name, and the known name that is most similar. `text`: what happens with it.
  void unknown(const MjcfElement& element, const std::string& text, std::span<const std::string_view> known,
               const std::string& fix, Severity severity = Severity::warning);
  /// True if unsupported() has this text already, which is then counted, or can't add another one: then its fix needs
  /// no search for a similar name.
  bool count_unsupported(const std::string& text);
  /// False if the list of problems is full.
  bool can_report() const { return problems_.list().size() < Problems::kMaxProblems; }
  /// Counts the attributes of an element that have no effect.
  void check_attributes(const MjcfElement& element) { check_attributes(element, element.name); }
  /// `kind`: the entry of the list of elements, where it isn't the element's name.
  void check_attributes(const MjcfElement& element, std::string_view kind);
  void report_deferred();

  /// The line in the model's file: for an included element, that of the <include>.
  int line_of(const MjcfElement& element) const;
  /// "<geom name='foot'>", for messages.
  std::string shown(const MjcfElement& element) const;

  MjcfCompiler compiler;

 private:
  struct DefaultClass {
    std::string name;
    std::optional<MjcfClass> parent;
    std::vector<const MjcfElement*> elements;
  };
  struct Deferred {
    int count = 0;
    const MjcfElement* first = nullptr;
    std::string fix;
    Severity severity = Severity::note;
  };

  /// Attributes of one kind of element that have no effect.
  struct Ignored {
    int count = 0;
    const MjcfElement* first = nullptr;
    std::set<std::string> attributes;
  };

  void report_ignored();
  void add_class(const MjcfElement& element, std::optional<MjcfClass> parent);
  std::string prefix(const MjcfElement& element) const;
  Quat euler(const std::vector<double>& angles) const;

  const MjcfDocument& document_;
  Problems& problems_;
  std::vector<DefaultClass> classes_{{"main", {}, {}}};
  std::map<std::string, MjcfClass, std::less<>> class_index_;
  std::map<std::string, Deferred> deferred_;
  std::map<std::string, Ignored> ignored_;  // by name of the element
};

}  // namespace limber::model
