"""The processes of the tests begin as those of the command `lagrotor` do, before numpy is imported."""

from lagrotor.process import begin_process

begin_process()
