// Where things stand in a URDF's text, and what must hold of the text before urdfdom reads it.
#pragma once

#include <tinyxml.h>

#include <string>

#include "io/result.h"

namespace selfcal {

class UrdfLines {
 public:
  /// Refuses text that is no XML, whose root is no `robot`, that is xacro nobody has run, that
  /// has names that are not UTF-8, which no file written of it could hold, or angles in degrees.
  static Result<UrdfLines> of(const std::string& text, const std::string& file);

  /// "FILE:LINE" of the `element` (link, joint) called `name`; "FILE" where there is none.
  std::string place(const char* element, const std::string& name) const;
  /// The place of what a message speaks of: the joint or link whose name it holds.
  std::string place_of(const std::string& message) const;

 private:
  UrdfLines(std::string file, TiXmlDocument document)
      : file_(std::move(file)), document_(std::move(document)) {}
  int line(const char* element, const std::string& name) const;

  std::string file_;
  TiXmlDocument document_;
};

}  // namespace selfcal
