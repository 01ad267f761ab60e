// SPDX-License-Identifier: Apache-2.0
#include <sqlite3.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <variant>

#include "bim/errors.h"
#include "scenarios/metrics/metrics.h"
#include "scenarios/sweep/table.h"

namespace plumbline::scenarios {

namespace {

using Value = std::optional<std::variant<std::string, double, int>>;

/// A database that is being written.
class Database {
 public:
  explicit Database(const std::string& path) : path_(path) {
    sqlite3* db = nullptr;
    const int code = sqlite3_open(path.c_str(), &db);
    db_.reset(db);
    check(code);
  }

  void run(const std::string& sql) { check(sqlite3_exec(db_.get(), sql.c_str(), nullptr, nullptr, nullptr)); }

  void insert(const std::string& table, const std::vector<Value>& values) {
    std::string sql = "INSERT INTO " + table + " VALUES (?";
    for (std::size_t i = 1; i < values.size(); ++i) sql += ",?";
    sqlite3_stmt* raw = nullptr;
    check(sqlite3_prepare_v2(db_.get(), (sql + ")").c_str(), -1, &raw, nullptr));
    const std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)> statement(raw, sqlite3_finalize);
    for (std::size_t i = 0; i < values.size(); ++i) bind(raw, static_cast<int>(i + 1), values[i]);
    if (sqlite3_step(raw) != SQLITE_DONE) fail();
  }

 private:
  void bind(sqlite3_stmt* statement, int at, const Value& value) {
    if (!value)
      check(sqlite3_bind_null(statement, at));
    else if (const auto* text = std::get_if<std::string>(&*value))
      check(sqlite3_bind_text(statement, at, text->c_str(), static_cast<int>(text->size()), SQLITE_TRANSIENT));
    else if (const auto* number = std::get_if<double>(&*value))
      check(sqlite3_bind_double(statement, at, *number));
    else
      check(sqlite3_bind_int(statement, at, std::get<int>(*value)));
  }
  void check(int code) {
    if (code != SQLITE_OK) fail();
  }
  [[noreturn]] void fail() {
    throw EnvironmentError(path_ + ": cannot be written: " + (db_ ? sqlite3_errmsg(db_.get()) : "out of memory"));
  }

  std::string path_;
  std::unique_ptr<sqlite3, decltype(&sqlite3_close)> db_{nullptr, sqlite3_close};
};

Value value_of(const std::optional<double>& number) { return number ? Value(*number) : Value(); }

void write_tables(Database& database, const std::vector<SweepRow>& rows, const std::vector<SweepCell>& cells) {
  std::string columns =
      "scenario TEXT, variant TEXT, start TEXT, seed TEXT, method TEXT, verdict TEXT, digest TEXT, identifiable "
      "INTEGER, evidence TEXT, failure TEXT, sensor_digest TEXT, method_digest TEXT";
  for (const score::MetricRow& metric : score::metrics()) columns += ", \"" + std::string(metric.name) + "\" REAL";
  database.run("PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF; BEGIN; CREATE TABLE runs (" + columns + ")");
  for (const SweepRow& row : rows) {
    std::vector<Value> values = {
        row.scenario,      row.variant,
        row.start,         row.seed,
        row.method,        row.verdict,
        row.digest,        row.identifiable ? Value(static_cast<int>(*row.identifiable)) : Value(),
        row.evidence,      row.failure,
        row.sensor_digest, row.method_digest};
    for (const auto& value : row.values) values.push_back(value_of(value));
    database.insert("runs", values);
  }
  database.run(
      "CREATE TABLE cells (scenario TEXT, variant TEXT, start TEXT, method TEXT, runs INTEGER, failed INTEGER, "
      "judged INTEGER, succeeded INTEGER, low REAL, high REAL, ambiguous INTEGER, honest INTEGER, weak INTEGER, "
      "weak_right INTEGER, wrong INTEGER, "
      "identifiable_at_s REAL, identifiable_at_m REAL, converged_at_m REAL, error_m REAL)");
  for (const SweepCell& c : cells) {
    const auto [low, high] = wilson95(c.succeeded, c.judged);
    database.insert("cells", {c.scenario, c.variant, c.start, c.method, c.runs, c.failed, c.judged, c.succeeded, low,
                              high, c.ambiguous, c.honest, c.marginal, c.marginal_right, c.false_convergences,
                              value_of(c.median_identifiable_at_s), value_of(c.median_identifiable_at_m),
                              value_of(c.median_converged_at_m), value_of(c.median_error_m)});
  }
  database.run("COMMIT");
}

}  // namespace

void write_database(const std::string& path, const std::vector<SweepRow>& rows, const std::vector<SweepCell>& cells) {
  const std::string temporary = path + ".tmp";
  ::unlink(temporary.c_str());
  {
    Database database(temporary);
    write_tables(database, rows, cells);
  }
  if (std::rename(temporary.c_str(), path.c_str()) != 0) throw EnvironmentError(path + ": cannot be written");
}

}  // namespace plumbline::scenarios
