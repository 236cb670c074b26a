"""JavaScript evaluated by one process of node, which begins with the first expression and ends with the tests."""

import json
import shutil
import subprocess
from functools import cache
from typing import Any

NODE = shutil.which("node")
_ANSWERS = """
require("readline").createInterface({ input: process.stdin }).on("line", (line) => {
  let answer;
  try { answer = { value: new Function(JSON.parse(line))() }; } catch (error) { answer = { error: error.stack }; }
  console.log(JSON.stringify(answer));
});
"""


@cache
def _process() -> subprocess.Popen[str]:
    command = [str(NODE), "--eval", _ANSWERS]
    return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, encoding="utf-8")


def value_of(expression: str, source: str) -> Any:
    """The value of a JavaScript expression after its source; a number that is not finite comes as None."""
    process = _process()
    assert process.stdin and process.stdout
    print(json.dumps(f'"use strict";\n{source}\nreturn {expression};'), file=process.stdin, flush=True)
    answer = json.loads(process.stdout.readline())
    assert "error" not in answer, answer["error"][-800:]
    return answer["value"]


def end() -> None:
    """End the process, where one began."""
    if _process.cache_info().currsize:
        _process().communicate()
        _process.cache_clear()
