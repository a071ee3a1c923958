// Reading the JSON that the program prints, by a parser that is not ours.
#pragma once

#include <boost/property_tree/json_parser.hpp>
#include <sstream>
#include <string>

namespace strut::test {

using JsonTree = boost::property_tree::ptree;

/// Throws where the text is not JSON.
inline JsonTree parse_json(const std::string& text) {
  std::istringstream stream(text);
  JsonTree tree;
  boost::property_tree::read_json(stream, tree);
  return tree;
}

}  // namespace strut::test
