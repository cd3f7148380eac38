#include "store/schema.h"

const char ethd__schema[] =
    "CREATE TABLE study (hash TEXT NOT NULL);\n"
    "CREATE TABLE hand (word TEXT PRIMARY KEY CHECK (" ETHD_STORE_HAND_RULE ")) WITHOUT ROWID;\n"
    "CREATE TABLE tap (id INTEGER PRIMARY KEY, point INTEGER NOT NULL, participant INTEGER NOT NULL, "
    "block INTEGER NOT NULL, attempt INTEGER NOT NULL, seed TEXT NOT NULL, tap TEXT NOT NULL, valid INTEGER NOT NULL, "
    "reason TEXT NOT NULL, " ETHD_STORE_FIGURES
    ", hand TEXT NOT NULL REFERENCES hand, movement TEXT, utc TEXT NOT NULL, "
    "by_ring TEXT NOT NULL, by_finger TEXT NOT NULL, "
    "CHECK (" ETHD_STORE_TAP_RULE "));\n"
    "CREATE UNIQUE INDEX tap_of ON tap (point, participant, block, attempt);\n"
    "CREATE TABLE answer (participant INTEGER NOT NULL, block INTEGER NOT NULL, question INTEGER NOT NULL, "
    "number INTEGER NOT NULL, words TEXT, PRIMARY KEY (participant, block, question)) WITHOUT ROWID;\n"
    "CREATE TABLE survey (id INTEGER PRIMARY KEY, participant INTEGER NOT NULL, block INTEGER NOT NULL);\n"
    "CREATE UNIQUE INDEX survey_of ON survey (participant, block);\n"
    "CREATE TABLE event (id INTEGER PRIMARY KEY, utc TEXT NOT NULL, participant INTEGER, block INTEGER, "
    "attempt INTEGER, event TEXT NOT NULL, detail TEXT NOT NULL);\n"
    "CREATE INDEX event_of ON event (participant);";
