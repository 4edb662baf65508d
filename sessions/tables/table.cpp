// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/table.h"

#include <algorithm>
#include <string_view>

#include "sessions/io/json/json_reader.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

std::string shownText(const TableCell& cell, const TableColumn& column) {
  if (cell.values.empty()) return cell.text;
  const bool any = std::any_of(cell.values.begin(), cell.values.end(),
                               [](const auto& value) { return value.has_value(); });
  if (!any) return "-";
  std::string text;
  for (const std::optional<double>& value : cell.values)
    text += (text.empty() ? "" : " / ") + (value ? fixedText(*value, column.decimals) : "-");
  return text;
}

std::string headText(const TableColumn& column) {
  std::string text = column.name;
  for (std::size_t i = 0; i < column.parts.size(); ++i)
    text += (i == 0 ? " " : " / ") + column.parts[i];
  return text;
}

std::string plainText(const Table& table) {
  std::vector<std::string> header;
  for (const TableColumn& column : table.columns) header.push_back(headText(column));
  TextTable text(header);
  for (const auto& row : table.rows) {
    std::vector<std::string> cells;
    for (std::size_t i = 0; i < row.size(); ++i)
      cells.push_back(shownText(row[i], table.columns[i]));
    text.add(cells);
  }
  std::string made = table.title + "\n" + text.text();
  for (const std::string& note : table.notes) made += note + "\n";
  return made;
}

std::string csvText(const Table& table) {
  std::string header;
  for (const TableColumn& column : table.columns) {
    if (column.parts.empty()) header += (header.empty() ? "" : ",") + csvField(column.name);
    for (const std::string& part : column.parts)
      header += (header.empty() ? "" : ",") + csvField(column.name + " " + part);
  }
  std::string made = header + "\r\n";
  for (const auto& row : table.rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (row[i].values.empty()) line += (i > 0 ? "," : "") + csvField(row[i].text);
      for (std::size_t part = 0; part < row[i].values.size(); ++part)
        line += (i + part > 0 ? "," : "") +
                (row[i].values[part] ? numberText(*row[i].values[part]) : std::string());
    }
    made += line + "\r\n";
  }
  return made;
}

std::string latexEscaped(const std::string& text) {
  std::string escaped;
  for (const char letter : text) {
    if (letter == '\\') {
      escaped += "\\textbackslash{}";
    } else if (letter == '~') {
      escaped += "\\textasciitilde{}";
    } else if (letter == '^') {
      escaped += "\\textasciicircum{}";
    } else {
      if (std::string_view("%&#_${}").find(letter) != std::string_view::npos) escaped += '\\';
      escaped += letter;
    }
  }
  return escaped;
}

std::string latexText(const Table& table) {
  std::string made = "\\begin{table}\n\\centering\n\\caption{" + latexEscaped(table.title) +
                     "}\n\\label{tab:" + table.name + "}\n\\begin{tabular}{";
  for (std::size_t i = 0; i < table.columns.size(); ++i) made += i == 0 ? "l" : "r";
  made += "}\n\\hline\n";
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    made += (i > 0 ? " & " : "") + latexEscaped(headText(table.columns[i]));
  made += " \\\\\n\\hline\n";
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i)
      made += (i > 0 ? " & " : "") + latexEscaped(shownText(row[i], table.columns[i]));
    made += " \\\\\n";
  }
  made += "\\hline\n\\end{tabular}\n";
  for (const std::string& note : table.notes)
    made += "\\par\\footnotesize " + latexEscaped(note) + "\n";
  return made + "\\end{table}\n";
}

}  // namespace

std::string tableText(const Table& table, TableFormat format) {
  if (format == TableFormat::kCsv) return csvText(table);
  return format == TableFormat::kLatex ? latexText(table) : plainText(table);
}

}  // namespace boresight::sessions
