// SPDX-License-Identifier: Apache-2.0
// Minimal SQLite access for results files; errors name the file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

struct sqlite3;
struct sqlite3_stmt;

namespace boresight::sessions {

/// NULL, INTEGER, REAL or TEXT.
using SqlValue = std::variant<std::monostate, std::int64_t, double, std::string>;

SqlValue sqlFlag(bool value);
SqlValue sqlFlag(const std::optional<bool>& value);
SqlValue sqlReal(const std::optional<double>& value);
/// NULL is read as an empty optional, as 0, or as "".
std::optional<double> realOf(const SqlValue& value);
std::int64_t integerOf(const SqlValue& value);
std::string textOf(const SqlValue& value);

enum class SqlAccess {
  kRead,   ///< the file must exist; failures are InputError
  kWrite,  ///< created when missing; failures are OutputError
};

/// An open SQLite file, read as data: its triggers and views are disabled. Waits up to 10 s for a
/// file that another process has locked. In a folder that cannot be written, a file with a log of
/// changes next to it (-wal, -journal) is refused; without one it is read as it is, unlocked, where
/// SQLite itself would have to write. Not thread-safe.
class SqlDatabase {
 public:
  SqlDatabase(const std::filesystem::path& file, SqlAccess access);
  SqlDatabase(SqlDatabase&&) noexcept;
  SqlDatabase& operator=(SqlDatabase&&) noexcept;
  ~SqlDatabase();

  const std::filesystem::path& file() const { return file_; }
  SqlAccess access() const { return access_; }
  /// One statement or several, without results.
  void execute(const std::string& sql);
  /// One statement with the values of ?1, ?2, ..., without results.
  void run(const std::string& sql, const std::vector<SqlValue>& values);
  /// The first cell of a query's first row, with the values of ?1, ?2, ...; NULL when there is
  /// none.
  SqlValue value(const std::string& sql, const std::vector<SqlValue>& values = {}) const;
  /// The names of a table's columns; empty when there is no such table.
  std::vector<std::string> columns(const std::string& table);
  std::int64_t lastId() const;

  /// Throws InputError or OutputError, according to access(), unless `code` is a success.
  void require(int code) const;
  /// Throws InputError or OutputError, according to access().
  [[noreturn]] void fail(const std::string& reason) const;
  sqlite3* handle() const { return handle_.get(); }

 private:
  void open(const std::string& name, int flags);
  void openAsItIs();

  struct Close {
    void operator()(sqlite3* handle) const;
  };
  std::filesystem::path file_;
  SqlAccess access_;
  std::unique_ptr<sqlite3, Close> handle_;
};

/// A statement that can be executed any number of times. Its database must outlive it.
class SqlStatement {
 public:
  SqlStatement(const SqlDatabase& database, const std::string& sql);
  /// Binds the values of ?1, ?2, ... and restarts.
  void bind(const std::vector<SqlValue>& values);
  /// Whether there is a (further) row.
  bool step();
  /// Binds and runs a statement without result rows.
  void run(const std::vector<SqlValue>& values);
  SqlValue cell(int column) const;
  std::vector<SqlValue> row() const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  const SqlDatabase* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// BEGIN ... COMMIT; the destructor rolls back uncommitted changes.
class SqlTransaction {
 public:
  explicit SqlTransaction(SqlDatabase& database);
  SqlTransaction(const SqlTransaction&) = delete;
  SqlTransaction& operator=(const SqlTransaction&) = delete;
  ~SqlTransaction();
  void commit();

 private:
  SqlDatabase* database_;
};

}  // namespace boresight::sessions
