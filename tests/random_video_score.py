"""VideoScore with small random networks, as a folder on disk in the form of the public one."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from drawn_weights import drawn_weights

__all__ = ["IMAGE_WORDS", "write_video_score_folder"]

IMAGE_WORDS = 4
"""So many places of the question does a picture take."""

_SPECIAL = ["<unk>", "<s>", "</s>", "<fake_token_around_image>", "<image>", "<end_of_utterance>"]
_SENTENCE = "Suppose you are an expert watch video text prompt frames a girl fox is : , . ( )"
_WORDS = [*_SPECIAL, *_SENTENCE.split()]


def write_video_score_folder(path: Path, *, seed: int = 0, shards: str = "5GB", **changed: Any) -> Path:
    """Write one.

    Args:
        path: of the folder.
        seed: of the weights.
        shards: largest size of a file.
        changed: other values of the configuration.
    """
    from physanimator.rendering.metrics.learned.idefics2_grader import Idefics2Grader
    from transformers import Idefics2Config

    config = Idefics2Config(
        **{
            "text_config": {
                "model_type": "mistral",
                "vocab_size": len(_WORDS),
                "hidden_size": 32,
                "intermediate_size": 48,
                "num_hidden_layers": 2,
                "num_attention_heads": 4,
                "num_key_value_heads": 2,
                "pad_token_id": 0,
            },
            "vision_config": {
                "hidden_size": 32,
                "intermediate_size": 48,
                "num_hidden_layers": 2,
                "num_attention_heads": 4,
                "image_size": 56,
                "patch_size": 14,
            },
            "perceiver_config": {
                "hidden_size": 32,
                "resampler_n_latents": IMAGE_WORDS,
                "resampler_depth": 1,
                "resampler_n_heads": 4,
                "resampler_head_dim": 8,
                "num_key_value_heads": 2,
            },
            "image_token_id": _WORDS.index("<image>"),
            "num_labels": 5,
        }
        | changed
    )
    network = Idefics2Grader(config)
    shapes = {name: tuple(tensor.shape) for name, tensor in network.state_dict().items()}
    network.load_state_dict(drawn_weights(shapes, seed=seed))
    network.save_pretrained(path, max_shard_size=shards)
    _write_tokenizer(path)
    processor = {
        "image_processor_type": "Idefics2ImageProcessor",
        "processor_class": "Idefics2Processor",
        "do_convert_rgb": True,
        "do_image_splitting": False,
        "do_normalize": True,
        "do_pad": True,
        "do_rescale": True,
        "do_resize": True,
        "image_mean": [0.5, 0.5, 0.5],
        "image_std": [0.5, 0.5, 0.5],
        "rescale_factor": 1 / 255,
        "resample": 2,
        "size": {"longest_edge": 56, "shortest_edge": 28},
    }
    (path / "preprocessor_config.json").write_text(json.dumps(processor))
    kept = {"processor_class": "Idefics2Processor", "image_seq_len": IMAGE_WORDS}
    (path / "processor_config.json").write_text(json.dumps(kept))
    return path


def _write_tokenizer(path: Path) -> None:
    from tokenizers import AddedToken, Tokenizer, models, pre_tokenizers, processors

    words = Tokenizer(models.WordLevel({word: number for number, word in enumerate(_WORDS)}, unk_token="<unk>"))
    words.pre_tokenizer = pre_tokenizers.Whitespace()
    words.post_processor = processors.TemplateProcessing(single="<s> $A", special_tokens=[("<s>", 1)])
    words.add_special_tokens([AddedToken(word, normalized=False, special=True) for word in _SPECIAL])
    words.save(str(path / "tokenizer.json"))
    kept = {
        "model_input_names": ["input_ids", "attention_mask"],
        "tokenizer_class": "PreTrainedTokenizerFast",
        "unk_token": "<unk>",
        "bos_token": "<s>",
        "eos_token": "</s>",
        "pad_token": "<unk>",
        "additional_special_tokens": _SPECIAL[3:],
    }
    (path / "tokenizer_config.json").write_text(json.dumps(kept))
