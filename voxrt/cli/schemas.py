"""The JSON schemas of what ``--json`` prints."""

from __future__ import annotations

from typing import Any

import msgspec

from voxrt.cli.results.board_results import CheckResult, ReportResult, ServeResult, UploadResult
from voxrt.cli.results.build_results import BuildReport, RenderResult
from voxrt.cli.results.memory_results import (
    CompareResult,
    ConvertResult,
    DiffResult,
    EditResult,
    InfoResult,
    TraceResult,
)

_RESULTS = (
    BuildReport,
    RenderResult,
    CompareResult,
    ConvertResult,
    EditResult,
    InfoResult,
    DiffResult,
    TraceResult,
    ServeResult,
    UploadResult,
    CheckResult,
    ReportResult,
)


def schema() -> dict[str, Any]:
    """Give the schemas of the results and of what they are made of, by name."""
    _, definitions = msgspec.json.schema_components(_RESULTS)
    return definitions
