#!/bin/sh
# fetch.sh NPM FOLDER: the packages of FOLDER/package-lock.json, from the npm registry.
if ! "$1" --prefix "$2" ci --ignore-scripts --no-audit --no-fund --loglevel=error; then
  echo "The libraries of the report's page could not be fetched from the npm registry." >&2
  echo "Without network configure with -DPOLYSLIP_REPORT=OFF; runs then leave no report.html." >&2
  exit 1
fi
